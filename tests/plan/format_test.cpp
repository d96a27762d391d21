// FORMAT.md is held to the code: its record tables give every field's offset and size, and a reader
// that knows only the page finds in a file what Plan finds.
#include <doctest/doctest.h>

#include <fmt/format.h>

#include <cstddef>
#include <cstring>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "runtime/plan/axes.h"
#include "runtime/plan/magnitudes.h"
#include "runtime/plan/plan.h"
#include "runtime/plan/readouts.h"
#include "runtime/plan/rules.h"
#include "tests/runtime/plan/question_plan.h"

using namespace probe::plan;

namespace {

struct Field {
  std::size_t at = 0, bytes = 0;
  std::string name;
  bool operator==(const Field&) const = default;
};

struct Record {
  std::size_t stride = 0;
  std::vector<Field> fields;
};

const std::string& page() {
  static const std::string text = [] {
    std::ifstream in(VLAPROBE_SOURCE_DIR "/runtime/plan/FORMAT.md", std::ios::binary);
    std::ostringstream out;
    out << in.rdbuf();
    return out.str();
  }();
  return text;
}

std::size_t size_of_type(std::istringstream& line) {
  static const std::map<std::string, std::size_t> kSizes = {
      {"u8", 1}, {"u16", 2}, {"u32", 4}, {"u64", 8}, {"f64", 8}, {"str", 8}, {"slice", 8}};
  std::string type, times;
  std::size_t count = 0;
  line >> type;
  if (type == "zero") {
    line >> count;
    return count;
  }
  REQUIRE_MESSAGE(kSizes.contains(type), "a type of the page: ", type);
  const std::size_t size = kSizes.at(type);
  return line >> times && times == "x" && line >> count ? size * count : size;
}

// The tables between "```" lines: "ASST 64   comment", then "8    kind   u32   comment".
std::map<std::string, Record> documented() {
  std::map<std::string, Record> records;
  std::istringstream lines(page());
  Record* record = nullptr;
  for (std::string text; std::getline(lines, text);) {
    std::istringstream line(text);
    std::string first;
    line >> first;
    if (first.empty() || first == "```") {
      record = nullptr;
    } else if (record != nullptr) {
      Field field{std::stoul(first), 0, ""};
      line >> field.name;
      field.bytes = size_of_type(line);
      record->fields.push_back(field);
    } else if (first.size() == 4 && text.size() > 5 && std::isdigit(text[5]) != 0) {
      record = &records[first];
      line >> record->stride;
    }
  }
  return records;
}

#define PROBE_FIELD(Struct, member) \
  Field { offsetof(Struct, member), sizeof(Struct::member), #member }

constexpr std::size_t kFinger = sizeof(FingerRecord);

const std::map<std::string, std::vector<Field>>& in_code() {
  static const std::map<std::string, std::vector<Field>> fields = {
      {"ASST",
       {PROBE_FIELD(AssetRecord, path), PROBE_FIELD(AssetRecord, kind),
        PROBE_FIELD(AssetRecord, zero), PROBE_FIELD(AssetRecord, byte_size),
        PROBE_FIELD(AssetRecord, sha256), PROBE_FIELD(AssetRecord, zero2)}},
      {"OBJT",
       {PROBE_FIELD(ObjectRecord, name), PROBE_FIELD(ObjectRecord, text),
        PROBE_FIELD(ObjectRecord, visual), PROBE_FIELD(ObjectRecord, collision),
        PROBE_FIELD(ObjectRecord, box_min), PROBE_FIELD(ObjectRecord, box_max),
        PROBE_FIELD(ObjectRecord, density), PROBE_FIELD(ObjectRecord, friction),
        PROBE_FIELD(ObjectRecord, scale), PROBE_FIELD(ObjectRecord, cover),
        PROBE_FIELD(ObjectRecord, paint), PROBE_FIELD(ObjectRecord, zero),
        PROBE_FIELD(ObjectRecord, mass), PROBE_FIELD(ObjectRecord, damping)}},
      {"MASS",
       {PROBE_FIELD(MassRecord, mass), PROBE_FIELD(MassRecord, centre),
        PROBE_FIELD(MassRecord, inertia)}},
      {"DAMP", {PROBE_FIELD(DampingRecord, shift), PROBE_FIELD(DampingRecord, turn)}},
      {"ROBT",
       {PROBE_FIELD(RobotRecord, name),
        PROBE_FIELD(RobotRecord, tcp),
        PROBE_FIELD(RobotRecord, urdf),
        PROBE_FIELD(RobotRecord, control),
        PROBE_FIELD(RobotRecord, control_hz),
        {offsetof(RobotRecord, fingers), sizeof(StringRef), "finger_0"},
        {offsetof(RobotRecord, fingers) + offsetof(FingerRecord, opens), 24, "opens_0"},
        {offsetof(RobotRecord, fingers) + kFinger, sizeof(StringRef), "finger_1"},
        {offsetof(RobotRecord, fingers) + kFinger + offsetof(FingerRecord, opens), 24, "opens_1"},
        PROBE_FIELD(RobotRecord, grip_closed),
        PROBE_FIELD(RobotRecord, grip_open),
        PROBE_FIELD(RobotRecord, finger_friction),
        PROBE_FIELD(RobotRecord, finger_patch),
        PROBE_FIELD(RobotRecord, link_friction),
        PROBE_FIELD(RobotRecord, reach_min),
        PROBE_FIELD(RobotRecord, reach_max),
        PROBE_FIELD(RobotRecord, drives),
        PROBE_FIELD(RobotRecord, meshes),
        PROBE_FIELD(RobotRecord, law),
        PROBE_FIELD(RobotRecord, gears),
        PROBE_FIELD(RobotRecord, more_fingers)}},
      {"LAWS",
       {PROBE_FIELD(LawRecord, kp), PROBE_FIELD(LawRecord, damping), PROBE_FIELD(LawRecord, output),
        PROBE_FIELD(LawRecord, null_kp), PROBE_FIELD(LawRecord, ramp),
        PROBE_FIELD(LawRecord, grip_pace), PROBE_FIELD(LawRecord, grip_stiffness),
        PROBE_FIELD(LawRecord, grip_limit), PROBE_FIELD(LawRecord, most),
        PROBE_FIELD(LawRecord, home), PROBE_FIELD(LawRecord, flags), PROBE_FIELD(LawRecord, zero),
        PROBE_FIELD(LawRecord, arm_path), PROBE_FIELD(LawRecord, finger_path)}},
      {"GEAR", {PROBE_FIELD(GearRecord, friction), PROBE_FIELD(GearRecord, armature)}},
      {"FING", {PROBE_FIELD(FingerRecord, link), PROBE_FIELD(FingerRecord, opens)}},
      {"DRIV",
       {PROBE_FIELD(DriveRecord, joint), PROBE_FIELD(DriveRecord, stiffness),
        PROBE_FIELD(DriveRecord, damping), PROBE_FIELD(DriveRecord, limit)}},
      {"CAMR",
       {PROBE_FIELD(CameraRecord, name), PROBE_FIELD(CameraRecord, mount_link),
        PROBE_FIELD(CameraRecord, aim), PROBE_FIELD(CameraRecord, width),
        PROBE_FIELD(CameraRecord, height), PROBE_FIELD(CameraRecord, samples),
        PROBE_FIELD(CameraRecord, position), PROBE_FIELD(CameraRecord, aim_values),
        PROBE_FIELD(CameraRecord, fx), PROBE_FIELD(CameraRecord, fy), PROBE_FIELD(CameraRecord, cx),
        PROBE_FIELD(CameraRecord, cy), PROBE_FIELD(CameraRecord, sensor)}},
      {"SENS",
       {PROBE_FIELD(SensorRecord, noise), PROBE_FIELD(SensorRecord, blur),
        PROBE_FIELD(SensorRecord, exposure), PROBE_FIELD(SensorRecord, patch),
        PROBE_FIELD(SensorRecord, dropped), PROBE_FIELD(SensorRecord, mirrored),
        PROBE_FIELD(SensorRecord, zero)}},
      {"LITE",
       {PROBE_FIELD(LightRecord, name), PROBE_FIELD(LightRecord, ambient),
        PROBE_FIELD(LightRecord, suns), PROBE_FIELD(LightRecord, occlusion),
        PROBE_FIELD(LightRecord, shading), PROBE_FIELD(LightRecord, color),
        PROBE_FIELD(LightRecord, lamps)}},
      {"LAMP",
       {PROBE_FIELD(LampRecord, kind), PROBE_FIELD(LampRecord, zero),
        PROBE_FIELD(LampRecord, position), PROBE_FIELD(LampRecord, direction),
        PROBE_FIELD(LampRecord, power), PROBE_FIELD(LampRecord, specular),
        PROBE_FIELD(LampRecord, ambient), PROBE_FIELD(LampRecord, cutoff),
        PROBE_FIELD(LampRecord, exponent), PROBE_FIELD(LampRecord, fade)}},
      {"SUNS",
       {PROBE_FIELD(SunRecord, direction), PROBE_FIELD(SunRecord, power),
        PROBE_FIELD(SunRecord, shadow), PROBE_FIELD(SunRecord, zero)}},
      {"SCNE",
       {PROBE_FIELD(SceneRecord, name),
        PROBE_FIELD(SceneRecord, robot),
        PROBE_FIELD(SceneRecord, photo),
        PROBE_FIELD(SceneRecord, backdrop),
        PROBE_FIELD(SceneRecord, fixture_visual),
        PROBE_FIELD(SceneRecord, fixture_collision),
        PROBE_FIELD(SceneRecord, backdrop_stands),
        PROBE_FIELD(SceneRecord, fixture_position),
        PROBE_FIELD(SceneRecord, base_position),
        PROBE_FIELD(SceneRecord, base_rotation),
        PROBE_FIELD(SceneRecord, joints),
        PROBE_FIELD(SceneRecord, surface_z),
        PROBE_FIELD(SceneRecord, area),
        PROBE_FIELD(SceneRecord, physics_hz),
        PROBE_FIELD(SceneRecord, friction),
        PROBE_FIELD(SceneRecord, fixtures),
        PROBE_FIELD(SceneRecord, air_density),
        PROBE_FIELD(SceneRecord, air_viscosity),
        PROBE_FIELD(SceneRecord, covers),
        PROBE_FIELD(SceneRecord, backdrop_z),
        PROBE_FIELD(SceneRecord, zero2)}},
      {"MOVE",
       {PROBE_FIELD(MoveRecord, body), PROBE_FIELD(MoveRecord, way), PROBE_FIELD(MoveRecord, to),
        PROBE_FIELD(MoveRecord, speed)}},
      {"COVR",
       {PROBE_FIELD(CoverRecord, what), PROBE_FIELD(CoverRecord, texture),
        PROBE_FIELD(CoverRecord, side)}},
      {"FIXT",
       {PROBE_FIELD(FixtureRecord, name), PROBE_FIELD(FixtureRecord, urdf),
        PROBE_FIELD(FixtureRecord, zero), PROBE_FIELD(FixtureRecord, position),
        PROBE_FIELD(FixtureRecord, rotation), PROBE_FIELD(FixtureRecord, friction),
        PROBE_FIELD(FixtureRecord, joints), PROBE_FIELD(FixtureRecord, parts),
        PROBE_FIELD(FixtureRecord, meshes), PROBE_FIELD(FixtureRecord, armatures),
        PROBE_FIELD(FixtureRecord, shown), PROBE_FIELD(FixtureRecord, zero2)}},
      {"SHOW",
       {PROBE_FIELD(ShownRecord, link), PROBE_FIELD(ShownRecord, joint),
        PROBE_FIELD(ShownRecord, side), PROBE_FIELD(ShownRecord, at)}},
      {"FJNT",
       {PROBE_FIELD(FixtureJointRecord, joint), PROBE_FIELD(FixtureJointRecord, motion),
        PROBE_FIELD(FixtureJointRecord, zero), PROBE_FIELD(FixtureJointRecord, lower),
        PROBE_FIELD(FixtureJointRecord, upper), PROBE_FIELD(FixtureJointRecord, friction),
        PROBE_FIELD(FixtureJointRecord, damping), PROBE_FIELD(FixtureJointRecord, stiffness),
        PROBE_FIELD(FixtureJointRecord, rest), PROBE_FIELD(FixtureJointRecord, start)}},
      {"PART",
       {PROBE_FIELD(PartRecord, name), PROBE_FIELD(PartRecord, link), PROBE_FIELD(PartRecord, text),
        PROBE_FIELD(PartRecord, joint), PROBE_FIELD(PartRecord, declared)}},
      {"REGN",
       {PROBE_FIELD(RegionRecord, name), PROBE_FIELD(RegionRecord, kind),
        PROBE_FIELD(RegionRecord, index), PROBE_FIELD(RegionRecord, low),
        PROBE_FIELD(RegionRecord, high)}},
      {"TURN",
       {PROBE_FIELD(TurnedRecord, region), PROBE_FIELD(TurnedRecord, zero),
        PROBE_FIELD(TurnedRecord, middle), PROBE_FIELD(TurnedRecord, half),
        PROBE_FIELD(TurnedRecord, rotation)}},
      {"STAT", {PROBE_FIELD(StateRecord, kind), PROBE_FIELD(StateRecord, n)}},
      {"CODE",
       {PROBE_FIELD(Instruction, op), PROBE_FIELD(Instruction, zero), PROBE_FIELD(Instruction, dst),
        PROBE_FIELD(Instruction, a), PROBE_FIELD(Instruction, b)}},
      {"PROG",
       {PROBE_FIELD(ProgramRecord, constants), PROBE_FIELD(ProgramRecord, states),
        PROBE_FIELD(ProgramRecord, code), PROBE_FIELD(ProgramRecord, metrics),
        PROBE_FIELD(ProgramRecord, hash)}},
      {"METR",
       {PROBE_FIELD(MetricRecord, name), PROBE_FIELD(MetricRecord, type),
        PROBE_FIELD(MetricRecord, readout)}},
      {"BODY",
       {PROBE_FIELD(BodyRecord, kind), PROBE_FIELD(BodyRecord, index),
        PROBE_FIELD(BodyRecord, name)}},
      {"PLAC",
       {PROBE_FIELD(PlacementRecord, object), PROBE_FIELD(PlacementRecord, zero),
        PROBE_FIELD(PlacementRecord, position), PROBE_FIELD(PlacementRecord, rotation)}},
      {"TASK", {PROBE_FIELD(TaskRecord, name),     PROBE_FIELD(TaskRecord, prompt),
                PROBE_FIELD(TaskRecord, scene),    PROBE_FIELD(TaskRecord, camera),
                PROBE_FIELD(TaskRecord, light),    PROBE_FIELD(TaskRecord, program),
                PROBE_FIELD(TaskRecord, source),   PROBE_FIELD(TaskRecord, target),
                PROBE_FIELD(TaskRecord, bodies),   PROBE_FIELD(TaskRecord, distractors),
                PROBE_FIELD(TaskRecord, horizon),  PROBE_FIELD(TaskRecord, baseline),
                PROBE_FIELD(TaskRecord, axes),     PROBE_FIELD(TaskRecord, ood),
                PROBE_FIELD(TaskRecord, idle),     PROBE_FIELD(TaskRecord, allow),
                PROBE_FIELD(TaskRecord, episodes), PROBE_FIELD(TaskRecord, drop),
                PROBE_FIELD(TaskRecord, settle),   PROBE_FIELD(TaskRecord, judge_id),
                PROBE_FIELD(TaskRecord, views),    PROBE_FIELD(TaskRecord, roles),
                PROBE_FIELD(TaskRecord, delay),    PROBE_FIELD(TaskRecord, zero),
                PROBE_FIELD(TaskRecord, moves),    PROBE_FIELD(TaskRecord, zero2)}},
      {"EPIS",
       {PROBE_FIELD(EpisodeRecord, task), PROBE_FIELD(EpisodeRecord, index),
        PROBE_FIELD(EpisodeRecord, placements), PROBE_FIELD(EpisodeRecord, start_id),
        PROBE_FIELD(EpisodeRecord, episode_id), PROBE_FIELD(EpisodeRecord, joints),
        PROBE_FIELD(EpisodeRecord, arm), PROBE_FIELD(EpisodeRecord, shaken),
        PROBE_FIELD(EpisodeRecord, zero)}},
      {"SETS", {PROBE_FIELD(SetRecord, name), PROBE_FIELD(SetRecord, members)}},
      {"SUIT",
       {PROBE_FIELD(SuiteRecord, name), PROBE_FIELD(SuiteRecord, prefix),
        PROBE_FIELD(SuiteRecord, trained_on), PROBE_FIELD(SuiteRecord, members),
        PROBE_FIELD(SuiteRecord, seeds), PROBE_FIELD(SuiteRecord, episodes),
        PROBE_FIELD(SuiteRecord, zero)}},
      {"VIEW",
       {PROBE_FIELD(ViewRecord, name), PROBE_FIELD(ViewRecord, camera),
        PROBE_FIELD(ViewRecord, photo)}},
      {"ROLE",
       {PROBE_FIELD(RoleRecord, name), PROBE_FIELD(RoleRecord, kind),
        PROBE_FIELD(RoleRecord, first), PROBE_FIELD(RoleRecord, count),
        PROBE_FIELD(RoleRecord, zero), PROBE_FIELD(RoleRecord, zero2)}},
      {"SKIL",
       {PROBE_FIELD(SkillRecord, task), PROBE_FIELD(SkillRecord, skill),
        PROBE_FIELD(SkillRecord, body), PROBE_FIELD(SkillRecord, relation),
        PROBE_FIELD(SkillRecord, to), PROBE_FIELD(SkillRecord, region),
        PROBE_FIELD(SkillRecord, amount)}},
      {"CLAM",
       {PROBE_FIELD(ClaimRecord, task), PROBE_FIELD(ClaimRecord, body),
        PROBE_FIELD(ClaimRecord, program), PROBE_FIELD(ClaimRecord, zero),
        PROBE_FIELD(ClaimRecord, text), PROBE_FIELD(ClaimRecord, zero2)}},
      {"THEN",
       {PROBE_FIELD(LaterRecord, task), PROBE_FIELD(LaterRecord, program),
        PROBE_FIELD(LaterRecord, text), PROBE_FIELD(LaterRecord, zero)}},
      {"QFAM",
       {PROBE_FIELD(FamilyRecord, set), PROBE_FIELD(FamilyRecord, name),
        PROBE_FIELD(FamilyRecord, text), PROBE_FIELD(FamilyRecord, form),
        PROBE_FIELD(FamilyRecord, moment), PROBE_FIELD(FamilyRecord, pixels),
        PROBE_FIELD(FamilyRecord, zero), PROBE_FIELD(FamilyRecord, zero2)}},
      {"QUES",
       {PROBE_FIELD(QuestionRecord, family), PROBE_FIELD(QuestionRecord, task),
        PROBE_FIELD(QuestionRecord, text), PROBE_FIELD(QuestionRecord, options),
        PROBE_FIELD(QuestionRecord, truth), PROBE_FIELD(QuestionRecord, right),
        PROBE_FIELD(QuestionRecord, a), PROBE_FIELD(QuestionRecord, b),
        PROBE_FIELD(QuestionRecord, program), PROBE_FIELD(QuestionRecord, zero),
        PROBE_FIELD(QuestionRecord, question_id), PROBE_FIELD(QuestionRecord, zero2)}},
      {"QOPT",
       {PROBE_FIELD(OptionRecord, text), PROBE_FIELD(OptionRecord, body),
        PROBE_FIELD(OptionRecord, flags), PROBE_FIELD(OptionRecord, words),
        PROBE_FIELD(OptionRecord, zero)}},
      {"QWRD", {PROBE_FIELD(StringRef, offset), PROBE_FIELD(StringRef, length)}},
      {"QOUT",
       {PROBE_FIELD(OmissionRecord, family), PROBE_FIELD(OmissionRecord, task),
        PROBE_FIELD(OmissionRecord, reason), PROBE_FIELD(OmissionRecord, zero)}},
      {"SPAN",
       {PROBE_FIELD(SpanRecord, what), PROBE_FIELD(SpanRecord, index),
        PROBE_FIELD(SpanRecord, text), PROBE_FIELD(SpanRecord, begin),
        PROBE_FIELD(SpanRecord, end)}},
      {"TEXT", {PROBE_FIELD(TextRecord, path), PROBE_FIELD(TextRecord, bytes)}},
  };
  return fields;
}

#undef PROBE_FIELD

// Reads a file by the page alone: offsets in the text, no struct of the program.
class PageReader {
 public:
  explicit PageReader(std::vector<std::byte> bytes) : bytes_(std::move(bytes)) {
    for (std::uint64_t i = 0; i < number(12, 4); ++i) {
      const std::size_t entry = 64 + 64 * i;
      sections_[number(entry, 4)] = {number(entry + 8, 8), number(entry + 24, 4),
                                     number(entry + 28, 4)};
    }
  }

  std::uint64_t number(std::size_t at, std::size_t bytes) const {
    std::uint64_t value = 0;
    for (std::size_t i = bytes; i-- > 0;)
      value = value << 8 | std::to_integer<std::uint64_t>(bytes_.at(at + i));
    return value;
  }
  std::size_t count(unsigned kind) const { return sections_.at(kind).count; }
  std::size_t at(unsigned kind, std::size_t index, std::size_t field) const {
    const Where& where = sections_.at(kind);
    return where.offset + index * where.stride + field;
  }
  std::uint64_t u32(unsigned kind, std::size_t index, std::size_t field) const {
    return number(at(kind, index, field), 4);
  }
  double f64(unsigned kind, std::size_t index, std::size_t field) const {
    return std::bit_cast<double>(number(at(kind, index, field), 8));
  }
  std::string text(unsigned kind, std::size_t index, std::size_t field) const {
    const std::size_t begin = sections_.at(1).offset + u32(kind, index, field);
    std::string out;
    for (std::size_t i = 0; i < u32(kind, index, field + 4); ++i)
      out.push_back(static_cast<char>(bytes_.at(begin + i)));
    return out;
  }

 private:
  struct Where {
    std::uint64_t offset = 0, count = 0, stride = 0;
  };
  std::vector<std::byte> bytes_;
  std::map<std::uint64_t, Where> sections_;
};

bool contains(const std::string& part) { return page().find(part) != std::string::npos; }

}  // namespace

TEST_CASE("the page gives every field of every record where the code has it") {
  const auto records = documented();
  CHECK(records.size() == in_code().size());
  for (const auto& [name, fields] : in_code()) {
    CAPTURE(name);
    REQUIRE(records.contains(name));
    const Record& record = records.at(name);
    REQUIRE(record.fields.size() == fields.size());
    std::size_t end = 0;
    for (std::size_t i = 0; i < fields.size(); ++i) {
      CAPTURE(fields[i].name);
      CHECK(record.fields[i] == fields[i]);
      CHECK(record.fields[i].at == end);  // no byte without a field
      end = record.fields[i].at + record.fields[i].bytes;
    }
    CHECK(record.stride == end);
  }
}

TEST_CASE("the page lists every section and axis as the code has them") {
  for (const SectionInfo& section : all_sections()) {
    const std::string row = "| " + std::to_string(static_cast<unsigned>(section.kind)) + " | " +
                            section.name + " | " + std::to_string(section.stride) + " | ";
    CHECK_MESSAGE(contains(row), row);
    const bool says = contains(row + "ignorable");
    CHECK(says == section.ignorable);
  }
  std::string flat = page();
  for (char& c : flat) c = c == '\n' ? ' ' : c;
  for (const AxisInfo& axis : kAxisTable) {
    const int number = std::countr_zero(bit(axis.axis));
    const std::string item = " " + std::to_string(number) + " " + std::string(axis.name);
    CHECK_MESSAGE(flat.find(item) != std::string::npos, item);
  }
}

TEST_CASE("the page lists the fields of every section that is made of records") {
#define PROBE_SECTION(kind, name, tag, Record, member, may_be_ignored) \
  CHECK_MESSAGE(in_code().contains(tag) == std::is_class_v<Record>, tag);
#include "runtime/plan/sections.def"
}

TEST_CASE("the page lists every read-out as the table has it") {
  std::string wanted;
  for (const ReadoutInfo& info : kReadoutTable) {
    wanted += (wanted.empty() ? "" : ", ") +
              std::to_string(static_cast<std::uint32_t>(info.readout)) + " " +
              std::string(info.words);
  }
  CHECK_MESSAGE(contains(wanted + "\n"), wanted);
}

TEST_CASE("a reader that knows the page alone finds what Plan finds") {
  const auto bytes = probe::plan::small_plan();
  const PageReader page_reader(bytes);
  const auto plan = Plan::from_bytes(bytes);
  REQUIRE(plan.ok());
  REQUIRE(page_reader.count(19) == plan->tasks().size());
  for (std::size_t t = 0; t < plan->tasks().size(); ++t) {
    const TaskRecord& task = plan->tasks()[t];
    CHECK(page_reader.text(19, t, 0) == plan->text(task.name));
    CHECK(page_reader.text(19, t, 8) == plan->text(task.prompt));
    CHECK(page_reader.u32(19, t, 52) == task.horizon);
    const auto episodes = plan->episodes(task);
    REQUIRE(page_reader.u32(19, t, 84) == episodes.size());
    for (std::size_t e = 0; e < episodes.size(); ++e) {
      const std::size_t episode = page_reader.u32(19, t, 80) + e;
      CHECK(page_reader.u32(20, episode, 4) == e);
      CHECK(page_reader.number(page_reader.at(20, episode, 16), 1) == episodes[e].start_id[0]);
      const std::size_t first = page_reader.u32(20, episode, 8);
      const auto placements = plan->placements(episodes[e]);
      REQUIRE(page_reader.u32(20, episode, 12) == placements.size());
      for (std::size_t p = 0; p < placements.size(); ++p) {
        CHECK(page_reader.text(5, page_reader.u32(18, first + p, 0), 0) ==
              plan->text(plan->objects()[placements[p].object].name));
        for (std::size_t k = 0; k < 3; ++k)
          CHECK(page_reader.f64(18, first + p, 8 + 8 * k) == placements[p].position[k]);
      }
    }
    const std::size_t program = page_reader.u32(19, t, 28);
    const auto code = plan->code(plan->programs()[program]);
    REQUIRE(page_reader.u32(15, program, 20) == code.size());
    for (std::size_t i = 0; i < code.size(); ++i) {
      const std::size_t at = page_reader.at(14, page_reader.u32(15, program, 16) + i, 0);
      CHECK(page_reader.number(at, 1) == code[i].op);
      CHECK(page_reader.number(at + 4, 2) == code[i].a);
    }
  }
}

TEST_CASE("a reader that knows the page alone finds the questions that Plan finds") {
  const auto bytes = probe::plan::question_plan();
  const PageReader page_reader(bytes);
  const auto plan = Plan::from_bytes(bytes);
  REQUIRE(plan.ok());
  REQUIRE(page_reader.count(25) == plan->questions().size());
  for (std::size_t q = 0; q < plan->questions().size(); ++q) {
    const QuestionRecord& question = plan->questions()[q];
    CHECK(page_reader.text(24, page_reader.u32(25, q, 0), 8) ==
          plan->text(plan->families()[question.family].name));
    CHECK(page_reader.text(25, q, 8) == plan->text(question.text));
    CHECK(page_reader.u32(25, q, 28) == question.right);
    REQUIRE(page_reader.u32(25, q, 20) == question.options.count);
    const std::size_t first = page_reader.u32(25, q, 16);
    for (std::size_t o = 0; o < question.options.count; ++o) {
      const OptionRecord& option = plan->options()[first + o];
      CHECK(page_reader.text(26, first + o, 0) == plan->text(option.text));
      CHECK(page_reader.u32(26, first + o, 8) == option.body);
      REQUIRE(page_reader.u32(26, first + o, 20) == option.words.count);
      for (std::size_t w = 0; w < option.words.count; ++w) {
        CHECK(page_reader.text(27, page_reader.u32(26, first + o, 16) + w, 0) ==
              plan->text(plan->words()[option.words.first + w]));
      }
    }
  }
  CHECK(page_reader.u32(28, 0, 8) == plan->omissions()[0].reason);
}

TEST_CASE("the page lists why a family asks nothing of a task, as the table has it") {
  std::string flat = page();
  for (char& c : flat) c = c == '\n' ? ' ' : c;
  const std::size_t begin = flat.find("Reasons: 1 ");
  REQUIRE(begin != std::string::npos);
  for (const OmissionInfo& info : kOmissions) {
    const std::string number = " " + std::to_string(static_cast<std::uint32_t>(info.id)) + " ";
    CHECK_MESSAGE(flat.find(number, begin) != std::string::npos, info.says);
  }
}

TEST_CASE("the page's magnitudes are the verifier's") {
  for (const MagnitudeInfo& known : kMagnitudes) {
    CAPTURE(known.what);
    const std::string unit = known.unit.empty() ? "" : " " + std::string(known.unit);
    const std::size_t row = page().find("| " + std::string(known.what));
    REQUIRE(row != std::string::npos);
    const std::string line = page().substr(row, page().find('\n', row) - row);
    const std::string least = known.least == 0 ? "0" : fmt::format("{:g}{}", known.least, unit);
    CHECK(line.ends_with(fmt::format("| {} | {:g}{} |", least, known.most, unit)));
  }
}
