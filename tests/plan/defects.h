// One defect a rule of the verifier, made on the small plan: a section where it is told, a part of
// the message, and how to make it. Shared by the tests of the verifier and by tests/plan, which
// keeps the resulting files.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "runtime/plan/ids.h"
#include "runtime/plan/regions.h"
#include "runtime/plan/verify.h"
#include "tests/runtime/plan/small_plan.h"

namespace probe::plan {

// A light of corners of triangles in the place of the first, with a spot.
inline void give_lamp(Records& r) {
  LampRecord spot;
  spot.kind = static_cast<std::uint32_t>(LampKind::kSpot);
  spot.position = {1, 1, 4};
  spot.direction = {0, 0, -1};
  spot.power = 0.8;
  r.lamps.push_back(spot);
  r.lights[0].suns = {};
  r.lights[0].occlusion = 0;
  r.lights[0].shading = 1;
  r.lights[0].lamps = {0, 1};
}

inline constexpr double kInf = std::numeric_limits<double>::infinity();

inline Header read_header(std::span<const std::byte> bytes) {
  Header header;
  std::memcpy(&header, bytes.data(), sizeof header);
  return header;
}

inline std::vector<DirectoryEntry> read_directory(std::span<const std::byte> bytes) {
  std::vector<DirectoryEntry> out(read_header(bytes).sections);
  std::memcpy(out.data(), bytes.data() + sizeof(Header), out.size() * sizeof(DirectoryEntry));
  return out;
}

// Writes the directory back and makes all hashes right again, so that deeper stages are reached.
// Entries that lie outside the file keep their hash.
inline void seal(std::vector<std::byte>& bytes, std::vector<DirectoryEntry> directory) {
  for (DirectoryEntry& e : directory) {
    if (e.offset > bytes.size() || e.size > bytes.size() - e.offset) continue;
    e.sha256 = sha256(std::span<const std::byte>(bytes).subspan(e.offset, e.size)).bytes;
  }
  Header header = read_header(bytes);
  header.root = root_hash(header, directory).bytes;
  std::memcpy(bytes.data(), &header, sizeof header);
  std::memcpy(bytes.data() + sizeof header, directory.data(),
              directory.size() * sizeof(DirectoryEntry));
}

// The failure of verify on a small plan whose records were changed after all ids were filled.
inline Failure failure_after(const std::function<void(Records&, Writer&)>& change) {
  Writer w = small_writer();
  std::ranges::reverse(w.records.spans);
  w.fill_ids();
  change(w.records, w);
  const Status status = verify(w.lay_out());
  return status.ok() ? Failure{} : status.failure();
}

// The first task seen by `count` cameras, all of them the plan's own.
inline void give_views(Records& r, Writer& w, std::uint32_t count) {
  for (std::uint32_t i = 0; i < count; ++i) {
    r.views.push_back({w.text("view_" + std::to_string(i)), 0, i == 0 ? r.scenes[0].photo : kNone});
  }
  r.tasks[0].views = {0, count};
}

struct Defect {
  const char* section;
  const char* rule;  // part of the message
  std::function<void(Records&, Writer&)> make;
};

struct EnvelopeDefect {
  const char* rule;  // part of the message
  std::function<void(Header&, std::vector<DirectoryEntry>&)> make;
};

inline std::vector<EnvelopeDefect> envelope_defects() {
  using Entries = std::vector<DirectoryEntry>;
  return {
      {"text mode", [](Header& h, Entries&) { h.magic[5] = '\n'; }},
      {"not a plan", [](Header& h, Entries&) { h.magic[1] = 'G'; }},
      {"reads format 1", [](Header& h, Entries&) { h.major = 2; }},
      {"reserved", [](Header& h, Entries&) { h.zero = 1; }},
      {"the plan says it has", [](Header& h, Entries&) { h.file_size += 1; }},
      {"does not fit", [](Header& h, Entries&) { h.sections = 0xffffffff; }},
      {"the root", [](Header& h, Entries&) { h.root[0] ^= 1; }},
      {"the root", [](Header& h, Entries&) { h.minor = 7; }},
      {"flags other", [](Header&, Entries& d) { d[0].flags = 2; }},
      {"must not be ignorable", [](Header&, Entries& d) { d[0].flags = 1; }},
      {"must be ignorable", [](Header&, Entries& d) { d.back().flags = 0; }},
      {"not known", [](Header&, Entries& d) { d.back().kind = 777; }},
      {"has version", [](Header&, Entries& d) { d[3].version = 2; }},
      {"have 64 bytes", [](Header&, Entries& d) { d[3].stride = 32; }},
      {"is empty", [](Header&, Entries& d) { d[3].count = 0; }},
      {"holds", [](Header&, Entries& d) { d[3].count += 1; }},
      {"holds", [](Header&, Entries& d) { d[3].size = ~std::uint64_t{0}; }},
      {"next multiple of 64", [](Header&, Entries& d) { d[3].offset += 64; }},
      {"next multiple of 64", [](Header&, Entries& d) { d[3].offset = ~std::uint64_t{63}; }},
      {"does not ascend",
       [](Header&, Entries& d) {
         std::swap(d[0].kind, d[24].kind), std::swap(d[0].flags, d[24].flags);
       }},
      {"SHA-256", [](Header&, Entries& d) { d[3].sha256[9] ^= 4; }},
      {"beyond the file", [](Header&, Entries& d) { d.back().count += 64, d.back().size += 64; }},
      {"ends where the file ends",
       [](Header&, Entries& d) { d.back().count -= 1, d.back().size -= 1; }},
  };
}

inline std::vector<Defect> catalogue_defects() {
  return {
      {"OBJT", "ends beyond",
       [](Records& r, Writer&) {
         r.objects[0].name = {0xffffffff, 0xffffffff};
       }},
      {"OBJT", "at most 4096 bytes",
       [](Records& r, Writer& w) { r.objects[0].text = w.text(std::string(5000, 'x')); }},
      {"OBJT", "is not UTF-8",
       [](Records& r, Writer& w) { r.objects[0].text = w.text("caf\xe9"); }},
      {"OBJT", "normal form C",
       [](Records& r, Writer& w) { r.objects[0].text = w.text("cafe\xcc\x81"); }},
      {"OBJT", "control character",
       [](Records& r, Writer& w) { r.objects[0].text = w.text("a\nb"); }},
      {"OBJT", "control character",
       [](Records& r, Writer& w) { r.objects[0].text = w.text("a\xc2\x85"); }},
      {"OBJT", "is not empty", [](Records& r, Writer&) { r.objects[0].name = {}; }},
      {"OBJT", "two objects are called",
       [](Records& r, Writer&) { r.objects[0].name = r.objects[1].name; }},
      {"OBJT", "record 99 of ASST", [](Records& r, Writer&) { r.objects[0].visual = 99; }},
      {"OBJT", "asset 1 has kind 2", [](Records& r, Writer&) { r.objects[0].visual = 1; }},
      {"OBJT", "finite", [](Records& r, Writer&) { r.objects[0].box_min[1] = -kInf; }},
      {"OBJT", "positive extent", [](Records& r, Writer&) { r.objects[0].box_max[1] = -1; }},
      {"OBJT", "a density", [](Records& r, Writer&) { r.objects[0].density = 0; }},
      {"OBJT", "a friction", [](Records& r, Writer&) { r.objects[0].friction = std::nan(""); }},
      {"OBJT", "reserved", [](Records& r, Writer&) { r.objects[0].zero = 1; }},
      {"ASST", "leads out", [](Records& r, Writer& w) { r.assets[0].path = w.text("../secret"); }},
      {"ASST", "leads out",
       [](Records& r, Writer& w) { r.assets[0].path = w.text("/etc/passwd"); }},
      {"ASST", "leads out", [](Records& r, Writer& w) { r.assets[0].path = w.text("a//b"); }},
      {"ASST", "kind 9", [](Records& r, Writer&) { r.assets[0].kind = 9; }},
      {"ASST", "at least one byte", [](Records& r, Writer&) { r.assets[0].byte_size = 0; }},
      {"ASST", "reserved", [](Records& r, Writer&) { r.assets[0].zero2 = 1; }},
      {"REAL", "finite", [](Records& r, Writer&) { r.reals[0] = kInf; }},
      {"DRIV", "the limit", [](Records& r, Writer&) { r.drives[0].limit = 0; }},
      {"ROBT", "one drive", [](Records& r, Writer&) { r.drives[0].joint = r.drives[1].joint; }},
      {"ROBT", "of DRIV",
       [](Records& r, Writer&) {
         r.robots[0].drives = {1, 0xffffffff};
       }},
      {"ROBT", "1 to 64 drives",
       [](Records& r, Writer&) {
         r.robots[0].drives = {0, 0};
       }},
      {"ROBT", "control law", [](Records& r, Writer&) { r.robots[0].control = 9; }},
      {"ROBT", "control rate", [](Records& r, Writer&) { r.robots[0].control_hz = -5; }},
      {"ROBT", "opening axis",
       [](Records& r, Writer&) {
         r.robots[0].fingers[1].opens = {0, 2, 0};
       }},
      {"ROBT", "record 4294967295 of ASST", [](Records& r, Writer&) { r.robots[0].urdf = kNone; }},
      {"ROBT", "least reach", [](Records& r, Writer&) { r.robots[0].reach_min = 1; }},
      {"LIST", "of ASST", [](Records& r, Writer&) { r.list[0] = 99; }},
      {"CAMR", "aims by", [](Records& r, Writer&) { r.cameras[0].aim = 3; }},
      {"CAMR", "other than zero",
       [](Records& r, Writer&) {
         r.cameras[0].aim_values = {0, 0, 0, 0};
       }},
      {"CAMR", "has length 1", [](Records& r, Writer&) { r.cameras[0].aim = 2; }},
      {"CAMR", "pixels a side", [](Records& r, Writer&) { r.cameras[0].width = 0; }},
      {"CAMR", "samples", [](Records& r, Writer&) { r.cameras[0].samples = 9; }},
      {"CAMR", "focal", [](Records& r, Writer&) { r.cameras[0].fy = 0; }},
      {"CAMR", "a focal length is from", [](Records& r, Writer&) { r.cameras[0].fx = 5e-324; }},
      {"CAMR", "a focal length is from", [](Records& r, Writer&) { r.cameras[0].fy = 1e300; }},
      {"CAMR", "the middle of a picture", [](Records& r, Writer&) { r.cameras[0].cx = -1e308; }},
      {"CAMR", "a coordinate", [](Records& r, Writer&) { r.cameras[0].position[2] = 1e9; }},
      {"CAMR", "the length of a direction",
       [](Records& r, Writer&) {
         r.cameras[0].aim_values = {1e-200, 0, 0, 0};
       }},
      {"SUNS", "the length of a direction",
       [](Records& r, Writer&) {
         r.suns[0].direction = {1e300, 1e300, 0};
       }},
      {"SUNS", "a light's strength", [](Records& r, Writer&) { r.suns[0].power = 1e39; }},
      {"LITE", "a light's strength", [](Records& r, Writer&) { r.lights[0].ambient = 1e7; }},
      {"SCNE", "a coordinate", [](Records& r, Writer&) { r.scenes[0].base_position[1] = 1e308; }},
      {"SCNE", "a coordinate", [](Records& r, Writer&) { r.scenes[0].surface_z = -1e4; }},
      {"SCNE", "an extent",
       [](Records& r, Writer&) {
         r.scenes[0].area = {0, 0, 5e-324, 1};
       }},
      {"SCNE", "a friction", [](Records& r, Writer&) { r.scenes[0].friction = 1e10; }},
      {"SCNE", "a physics rate", [](Records& r, Writer&) { r.scenes[0].physics_hz = 1e-300; }},
      {"SCNE", "a physics rate", [](Records& r, Writer&) { r.scenes[0].physics_hz = 45; }},
      {"REAL", "a joint's position", [](Records& r, Writer&) { r.reals[0] = 1e6; }},
      {"DRIV", "a drive's gain", [](Records& r, Writer&) { r.drives[0].stiffness = 1e20; }},
      {"DRIV", "the limit of a drive", [](Records& r, Writer&) { r.drives[0].limit = 1e-300; }},
      {"ROBT", "a control rate", [](Records& r, Writer&) { r.robots[0].control_hz = 1e-9; }},
      {"ROBT", "a joint's position", [](Records& r, Writer&) { r.robots[0].grip_open = 1e5; }},
      {"ROBT", "a length", [](Records& r, Writer&) { r.robots[0].reach_max = 1e5; }},
      {"OBJT", "a density", [](Records& r, Writer&) { r.objects[0].density = 5e-324; }},
      {"OBJT", "an extent",
       [](Records& r, Writer&) { r.objects[0].box_max[1] = r.objects[0].box_min[1] + 1e-12; }},
      {"SUNS", "other than zero",
       [](Records& r, Writer&) {
         r.suns[0].direction = {0, 0, 0};
       }},
      {"SUNS", "shadows", [](Records& r, Writer&) { r.suns[0].shadow = 2; }},
      {"LITE", "corners of triangles (1)",
       [](Records& r, Writer&) { give_lamp(r), r.lights[0].shading = 2; }},
      {"LITE", "no pixels", [](Records& r, Writer&) { give_lamp(r), r.lights[0].shading = 0; }},
      {"LITE", "no suns", [](Records& r, Writer&) { r.lights[0].shading = 1; }},
      {"LITE", "of LAMP", [](Records& r, Writer&) { give_lamp(r), r.lights[0].lamps.count = 2; }},
      {"LAMP", "a headlight (3)", [](Records& r, Writer&) { give_lamp(r), r.lamps[0].kind = 4; }},
      {"LAMP", "only a spot has a place",
       [](Records& r, Writer&) { give_lamp(r), r.lamps[0].kind = 3; }},
      {"LAMP", "have a direction",
       [](Records& r, Writer&) {
         give_lamp(r), r.lamps[0].direction = {0, 0, 0};
       }},
      {"LAMP", "the strength of a lamp",
       [](Records& r, Writer&) { give_lamp(r), r.lamps[0].specular = -1; }},
      {"LAMP", "a quarter turn", [](Records& r, Writer&) { give_lamp(r), r.lamps[0].cutoff = 2; }},
      {"LAMP", "exponent", [](Records& r, Writer&) { give_lamp(r), r.lamps[0].exponent = 129; }},
      {"LAMP", "the fading", [](Records& r, Writer&) { give_lamp(r), r.lamps[0].fade[1] = -1; }},
      {"LITE", "traced", [](Records& r, Writer&) { r.lights[0].occlusion = 17; }},
      {"LITE", "of SUNS", [](Records& r, Writer&) { r.lights[0].suns.count = 2; }},
      {"SCNE", "of ROBT", [](Records& r, Writer&) { r.scenes[0].robot = 1; }},
      {"SCNE", "joint positions", [](Records& r, Writer&) { r.scenes[0].joints.count = 1; }},
      {"SCNE", "has length 1",
       [](Records& r, Writer&) { r.scenes[0].base_rotation[0] = 1 + 1e-11; }},
      {"SCNE", "extent", [](Records& r, Writer&) { r.scenes[0].area[2] = -1; }},
      {"SCNE", "whole number", [](Records& r, Writer&) { r.scenes[0].physics_hz = 501; }},
      {"VIEW", "of CAMR",
       [](Records& r, Writer& w) { give_views(r, w, 2), r.views[1].camera = 7; }},
      {"VIEW", "a letter first",
       [](Records& r, Writer& w) { give_views(r, w, 2), r.views[1].name = w.text("the wrist"); }},
      {"VIEW", "has kind",
       [](Records& r, Writer& w) { give_views(r, w, 2), r.views[1].photo = 1; }},
  };
}

// Roles of the first task: `second` behind `first`.
inline void give_roles(Records& r, const RoleRecord& first, const RoleRecord& second) {
  r.roles = {first, second};
  r.tasks[0].roles = {0, 2};
}

// Claims that the words mean the first object, and not the second.
inline void give_claims(Records& r, Writer& w, std::uint32_t count) {
  ProgramRecord program;
  const std::vector<Instruction> code = {
      make_instruction(Op::kKB, 0, 1), make_instruction(Op::kKB, 1, 0),
      make_instruction(Op::kEMITB, 2, 0, 0), make_instruction(Op::kEMITB, 2, 1, 1),
      make_instruction(Op::kEND, 2)};
  const auto truth = static_cast<std::uint32_t>(MetricType::kBool);
  const auto at_end = static_cast<std::uint32_t>(Readout::kAtEnd);
  const std::vector<MetricRecord> metrics = {{w.text("body_0"), truth, at_end},
                                             {w.text("body_1"), truth, at_end}};
  program.code = append<Instruction>(r.code, code);
  program.metrics = append<MetricRecord>(r.metrics, metrics);
  program.hash = program_hash(r.tables(), program).bytes;
  r.programs.push_back(program);
  for (std::uint32_t i = 0; i < count; ++i) {
    ClaimRecord claim;
    claim.task = i;
    claim.body = 0;
    claim.program = static_cast<std::uint32_t>(r.programs.size() - 1);
    claim.text = w.text("carrot on the left");
    r.claims.push_back(claim);
  }
}

// The first tasks say "stop" when something holds that never does.
inline void give_later(Records& r, Writer& w, std::uint32_t count) {
  ProgramRecord program;
  const std::vector<Instruction> code = {make_instruction(Op::kKB, 0, 0),
                                         make_instruction(Op::kEMITB, 1, 0, 0),
                                         make_instruction(Op::kEND, 1)};
  const std::vector<MetricRecord> metrics = {{w.text("when"),
                                              static_cast<std::uint32_t>(MetricType::kBool),
                                              static_cast<std::uint32_t>(Readout::kAtEnd)}};
  program.code = append<Instruction>(r.code, code);
  program.metrics = append<MetricRecord>(r.metrics, metrics);
  program.hash = program_hash(r.tables(), program).bytes;
  r.programs.push_back(program);
  for (std::uint32_t i = 0; i < count; ++i)
    r.later.push_back({i, static_cast<std::uint32_t>(r.programs.size() - 1), w.text("stop"), {}});
}

// A texture on the given part, of nobody yet.
inline void give_cover(Records& r, Writer& w, std::uint32_t what) {
  r.covers.push_back({what, add_asset(w, "textures/wood.png", AssetKind::kPhoto), 0.1});
}

// A region of the first object, turned by 90 degrees about z.
inline void give_turned(Records& r, Writer& w) {
  const TurnedBox box{{0.1, 0, 0}, {0.1, 0.2, 0.3}, {std::sqrt(0.5), 0, 0, std::sqrt(0.5)}};
  RegionRecord region{
      w.text("pear.inside"), static_cast<std::uint32_t>(BodyKind::kObject), 0, {}, {}};
  box_around(box, region.low, region.high);
  const auto index = static_cast<std::uint32_t>(r.regions.size());
  r.turned.push_back({index, 0, box.middle, box.half, box.rotation});
  r.regions.push_back(region);
}

// Its first object goes 10 cm along x and back.
inline void give_move(Records& r) {
  r.moves.push_back({0, 0, {0.1, 0}, 0.05});
  r.tasks[0].moves = {0, 1};
}

// Of the first task: its source put onto its target, `count` times over the tasks.
inline void give_skills(Records& r, std::uint32_t count) {
  for (std::uint32_t i = 0; i < count; ++i) {
    SkillRecord skill;
    skill.task = i;
    skill.skill = static_cast<std::uint32_t>(Skill::kPut);
    skill.body = 0;
    skill.relation = static_cast<std::uint32_t>(SkillRelation::kOn);
    skill.to = 1;
    r.skills.push_back(skill);
  }
}

inline std::vector<Defect> task_defects() {
  return {
      {"SKIL", "stands behind one of task 1",
       [](Records& r, Writer&) { give_skills(r, 2), std::swap(r.skills[0], r.skills[1]); }},
      {"SKIL", "skill 8 is not known",
       [](Records& r, Writer&) { give_skills(r, 1), r.skills[0].skill = 8; }},
      {"SKIL", "relation 4 is none of `put`",
       [](Records& r, Writer&) { give_skills(r, 1), r.skills[0].relation = 4; }},
      {"SKIL", "has no amount",
       [](Records& r, Writer&) { give_skills(r, 1), r.skills[0].amount = 1; }},
      {"SKIL", "to one body or region",
       [](Records& r, Writer&) { give_skills(r, 1), r.skills[0].to = kNone; }},
      {"SKIL", "has no body 99",
       [](Records& r, Writer&) { give_skills(r, 1), r.skills[0].body = 99; }},
      {"SKIL", "is no object of task",
       [](Records& r, Writer&) { give_skills(r, 1), r.skills[0].body = 2; }},
      {"SKIL", "is no part that a joint moves",
       [](Records& r, Writer&) {
         give_skills(r, 1), r.skills[0].skill = static_cast<std::uint32_t>(Skill::kOpen);
         r.skills[0].relation = 0, r.skills[0].to = kNone;
       }},
      {"SKIL", "is of nothing in task",
       [](Records& r, Writer& w) {
         give_skills(r, 1);
         r.objects.push_back(r.objects[0]);
         r.objects.back().name = w.text("pear");
         r.regions.push_back({w.text("pear.inside"),
                              static_cast<std::uint32_t>(BodyKind::kObject),
                              static_cast<std::uint32_t>(r.objects.size() - 1),
                              {},
                              {1, 1, 1}});
         r.skills[0].to = kNone;
         r.skills[0].region = static_cast<std::uint32_t>(r.regions.size() - 1);
       }},
      {"SKIL", "cannot be put to body 0",
       [](Records& r, Writer&) { give_skills(r, 1), r.skills[0].to = 0; }},
      {"CLAM", "stands behind one of task 1",
       [](Records& r, Writer& w) { give_claims(r, w, 2), std::swap(r.claims[0], r.claims[1]); }},
      {"CLAM", "is no object or part of task",
       [](Records& r, Writer& w) { give_claims(r, w, 1), r.claims[0].body = 2; }},
      {"CLAM", "remembers nothing",
       [](Records& r, Writer& w) { give_claims(r, w, 1), r.claims[0].program = 0; }},
      {"CLAM", "is no truth of an object",
       [](Records& r, Writer& w) { give_claims(r, w, 1), r.metrics[3].name = w.text("body_2"); }},
      {"CLAM", "does not say whether body 0",
       [](Records& r, Writer& w) {
         give_claims(r, w, 1), r.metrics[3].name = w.text("body_1");
         r.programs[1].metrics.count = 1;
       }},
      {"THEN", "stands behind one of task 1",
       [](Records& r, Writer& w) { give_later(r, w, 2), std::swap(r.later[0], r.later[1]); }},
      {"THEN", "twice in turn",
       [](Records& r, Writer& w) { give_later(r, w, 1), r.later[0].text = r.tasks[0].prompt; }},
      {"THEN", "is one truth",
       [](Records& r, Writer& w) { give_later(r, w, 1), r.later[0].program = 0; }},
      {"OBJT", "scaled by", [](Records& r, Writer&) { r.objects[0].scale = 1000; }},
      {"OBJT", "a density or a mass",
       [](Records& r, Writer&) {
         r.masses.push_back({0.2, {}, {}}), r.objects[0].mass = {0, 1};
       }},
      {"MASS", "has an inertia",
       [](Records& r, Writer&) {
         r.masses.push_back({0.2, {0, 0, 0.1}, {}}), r.objects[0].mass = {0, 1};
         r.objects[0].density = 0;
       }},
      {"MASS", "exceeds the sum",
       [](Records& r, Writer&) {
         r.masses.push_back({0.2, {}, {1, 1, 3, 0, 0, 0}}), r.objects[0].mass = {0, 1};
         r.objects[0].density = 0;
       }},
      {"MASS", "belongs to nobody",
       [](Records& r, Writer&) {
         r.masses.push_back({0.2, {}, {}});
       }},
      {"SCNE", "a backdrop stands", [](Records& r, Writer&) { r.scenes[0].backdrop_stands = 2; }},
      {"SCNE", "a backdrop stands",
       [](Records& r, Writer&) {
         r.scenes[0].backdrop = kNone, r.scenes[0].backdrop_stands = 1;
       }},
      {"SCNE", "a backdrop stands", [](Records& r, Writer&) { r.scenes[0].backdrop_z = 0.9; }},
      {"DAMP", "resists nothing",
       [](Records& r, Writer&) {
         r.dampings.push_back({0, 0}), r.objects[0].damping = {0, 1};
       }},
      {"DAMP", "a damping",
       [](Records& r, Writer&) {
         r.dampings.push_back({0.1, -0.1}), r.objects[0].damping = {0, 1};
       }},
      {"DAMP", "belongs to nobody",
       [](Records& r, Writer&) {
         r.dampings.push_back({0.1, 0});
       }},
      {"OBJT", "is painted",
       [](Records& r, Writer&) {
         r.objects[0].paint = {9, 0, 0, 0};
       }},
      {"COVR", "covers all of it",
       [](Records& r, Writer& w) {
         give_cover(r, w, 1), r.objects[0].cover = {0, 1};
       }},
      {"COVR", "each once",
       [](Records& r, Writer& w) {
         give_cover(r, w, 2), give_cover(r, w, 1), r.scenes[0].covers = {0, 2};
       }},
      {"COVR", "is not known",
       [](Records& r, Writer& w) {
         give_cover(r, w, 5), r.scenes[0].covers = {0, 1};
       }},
      {"COVR", "belongs to nobody", [](Records& r, Writer& w) { give_cover(r, w, 4); }},
      {"OBJT", "of two records",
       [](Records& r, Writer& w) {
         give_cover(r, w, 4), r.objects[0].cover = r.objects[1].cover = {0, 1};
       }},
      {"SENS", "noise and dropped",
       [](Records& r, Writer&) {
         r.sensors.push_back({1.5, 0, 0, {}, 0, 0, 0}), r.cameras[0].sensor = {0, 1};
       }},
      {"LITE", "the colour of a light", [](Records& r, Writer&) { r.lights[0].color[1] = -1; }},
      {"TASK", "acts after at most", [](Records& r, Writer&) { r.tasks[0].delay = 1001; }},
      {"EPIS", "its robot has 2 drives",
       [](Records& r, Writer&) {
         r.episodes[0].arm = {0, 1};
       }},
      {"MOVE", "way 4 is not known", [](Records& r, Writer&) { give_move(r), r.moves[0].way = 4; }},
      {"MOVE", "things move at", [](Records& r, Writer&) { give_move(r), r.moves[0].speed = 0; }},
      {"MOVE", "a leg ends where it begins",
       [](Records& r, Writer&) {
         give_move(r), r.moves[0].to = {0, 0};
       }},
      {"MOVE", "a circle has one leg",
       [](Records& r, Writer&) {
         give_move(r), r.moves[0].way = 3, r.moves.push_back(r.moves[0]);
         r.moves[1].to = {0.2, 0}, r.tasks[0].moves.count = 2;
       }},
      {"MOVE", "is no object", [](Records& r, Writer&) { give_move(r), r.moves[0].body = 99; }},
      {"MOVE", "belongs to no task",
       [](Records& r, Writer&) { give_move(r), r.tasks[0].moves.count = 0; }},
      {"MOVE", "legs of a body are alike",
       [](Records& r, Writer&) {
         give_move(r), r.moves.push_back(r.moves[0]), r.moves[1].speed = 0.1;
         r.moves[1].to = {0.2, 0}, r.tasks[0].moves.count = 2;
       }},
      {"TURN", "has a positive extent",
       [](Records& r, Writer& w) { give_turned(r, w), r.turned[0].half[1] = 0; }},
      {"TURN", "the rotation of a region",
       [](Records& r, Writer& w) { give_turned(r, w), r.turned[0].rotation[1] = 1; }},
      {"TURN", "is not the box around",
       [](Records& r, Writer& w) { give_turned(r, w), r.regions.back().high[0] += 0.01; }},
      {"TURN", "turned regions ascend",
       [](Records& r, Writer& w) { give_turned(r, w), r.turned.push_back(r.turned[0]); }},
      {"TASK", "idles for at most", [](Records& r, Writer&) { r.tasks[0].idle = 1001; }},
      {"METR", "at most one metric of a program ends",
       [](Records& r, Writer&) { r.metrics[0].readout = r.metrics[2].readout = 9; }},
      {"METR", "at most one metric of a program ends",
       [](Records& r, Writer&) { r.metrics[1].readout = 9; }},
      {"ROLE", "role kind",
       [](Records& r, Writer& w) {
         r.roles.push_back({w.text("helper"), 9, 2, 1});
       }},
      {"ROLE", "ends beyond the",
       [](Records& r, Writer&) {
         r.roles.push_back({{1u << 30, 0}, 3, 2, 1});
       }},
      {"ROLE", "a name of its own",
       [](Records& r, Writer& w) {
         r.roles.push_back({w.text("source"), 1, 2, 1});
       }},
      {"ROLE", "2 bodies fill a role",
       [](Records& r, Writer& w) {
         r.roles.push_back({w.text("helper"), 1, 2, 2});
       }},
      {"TASK", "begins at body 4, not 3",
       [](Records& r, Writer& w) {
         give_roles(r, {w.text("helper"), 1, 2, 1}, {w.text("goods"), 2, 4, 1});
       }},
      {"TASK", "two roles of task",
       [](Records& r, Writer& w) {
         give_roles(r, {w.text("helper"), 1, 2, 1}, {w.text("helper"), 2, 3, 1});
       }},
      {"CNST", "finite", [](Records& r, Writer&) { r.constants[0] = std::nan(""); }},
      {"STAT", "not a monitor", [](Records& r, Writer&) { r.states[0].kind = 0x30; }},
      {"STAT", "at least one step", [](Records& r, Writer&) { r.states[1].n = 0; }},
      {"STAT", "n = 0", [](Records& r, Writer&) { r.states[0].n = 1; }},
      {"STAT", "belongs to a program",
       [](Records& r, Writer&) { r.states.push_back(r.states[0]); }},
      {"CODE", "belongs to a program", [](Records& r, Writer&) { r.code.push_back(r.code[0]); }},
      {"METR", "metric type", [](Records& r, Writer&) { r.metrics[0].type = 0; }},
      {"METR", "readout", [](Records& r, Writer&) { r.metrics[0].readout = 99; }},
      {"PROG", "have one name", [](Records& r, Writer&) { r.metrics[0].name = r.metrics[1].name; }},
      {"PROG", "of CNST", [](Records& r, Writer&) { r.programs[0].constants.first = 1; }},
      {"PROG", "must begin",
       [](Records& r, Writer&) {
         r.programs[0].code = {1, 5};
       }},
      {"BODY", "body kind", [](Records& r, Writer&) { r.bodies[0].kind = 0; }},
      {"BODY", "of OBJT", [](Records& r, Writer&) { r.bodies[0].index = 2; }},
      {"BODY", "has kind", [](Records& r, Writer&) { r.bodies[2].kind = 3; }},
      {"BODY", "first body is the source", [](Records& r, Writer&) { r.bodies[0].index = 1; }},
      {"BODY", "is finger", [](Records& r, Writer&) { r.bodies[3].name = r.bodies[5].name; }},
      {"BODY", "numbered", [](Records& r, Writer&) { r.bodies[5].index = 7; }},
      {"PLAC", "has length 1",
       [](Records& r, Writer&) {
         r.placements[0].rotation = {1, 1, 0, 0};
       }},
      {"PLAC", "a coordinate", [](Records& r, Writer&) { r.placements[0].position[0] = 1e20; }},
      {"TASK", "a length", [](Records& r, Writer&) { r.tasks[0].drop = 1e4; }},
      {"PLAC", "finite", [](Records& r, Writer&) { r.placements[0].position[2] = kInf; }},
      {"TASK", "two tasks are called",
       [](Records& r, Writer&) { r.tasks[1].name = r.tasks[0].name; }},
      {"TASK", "a letter first, not `../outside`",
       [](Records& r, Writer& w) { r.tasks[0].name = w.text("../outside"); }},
      {"SUIT", "a letter first", [](Records& r, Writer& w) { r.suites[0].name = w.text("a/b"); }},
      {"METR", "a letter first", [](Records& r, Writer& w) { r.metrics[0].name = w.text("1st"); }},
      {"OBJT", "a letter first", [](Records& r, Writer& w) { r.objects[0].name = w.text("a b"); }},
      {"TASK", "is not empty", [](Records& r, Writer&) { r.tasks[0].name = {}; }},
      {"TASK", "of PROG", [](Records& r, Writer&) { r.tasks[0].program = 1; }},
      {"TASK", "a horizon", [](Records& r, Writer&) { r.tasks[0].horizon = 0; }},
      {"TASK", "a settling time is at most", [](Records& r, Writer&) { r.tasks[0].settle = 61; }},
      {"TASK", "its own baseline", [](Records& r, Writer&) { r.tasks[0].baseline = 1; }},
      {"TASK", "its own baseline", [](Records& r, Writer&) { r.tasks[1].baseline = 1; }},
      {"TASK", "axes 0x80000000", [](Records& r, Writer&) { r.tasks[1].axes = 0x80000000; }},
      {"TASK", "no axis", [](Records& r, Writer&) { r.tasks[0].axes = 1; }},
      {"TASK", "ood", [](Records& r, Writer&) { r.tasks[0].ood = 8; }},
      {"TASK", "of VIEW", [](Records& r, Writer&) { r.tasks[0].views.count = 1; }},
      {"TASK", "at most 16 cameras", [](Records& r, Writer& w) { give_views(r, w, 17); }},
      {"TASK", "is not its own",
       [](Records& r, Writer& w) { give_views(r, w, 2), r.views[0].photo = kNone; }},
      {"TASK", "are called `view_0`",
       [](Records& r, Writer& w) { give_views(r, w, 2), r.views[1].name = r.views[0].name; }},
      {"TASK", "bodies; with its",
       [](Records& r, Writer&) { r.tasks[0].distractors = 0xffffffff; }},
      {"TASK", "has no episode", [](Records& r, Writer&) { r.tasks[0].episodes.count = 0; }},
      {"EPIS", "stands among",
       [](Records& r, Writer&) { r.tasks[0].episodes = r.tasks[1].episodes; }},
      {"EPIS", "tasks name 3", [](Records& r, Writer&) { r.tasks[1].episodes.count = 1; }},
      {"EPIS", "says it is", [](Records& r, Writer&) { r.episodes[1].index = 0; }},
      {"EPIS", "places 1 objects", [](Records& r, Writer&) { r.episodes[1].placements.count = 1; }},
      {"EPIS", "placement 0 is of object",
       [](Records& r, Writer&) { r.episodes[1].placements.first = 1; }},
      {"EPIS", "of PLAC", [](Records& r, Writer&) { r.episodes[1].placements.first = 3; }},
      {"LIST", "twice", [](Records& r, Writer&) { r.list[3] = r.list[2]; }},
      {"LIST", "of TASK", [](Records& r, Writer&) { r.list[2] = 7; }},
      {"SUIT", "share entries",
       [](Records& r, Writer&) { r.sets[0].members = r.suites[0].members; }},
      {"SUIT", "of LIST", [](Records& r, Writer&) { r.suites[0].seeds.count = 100; }},
      {"SUIT", "of LIST",
       [](Records& r, Writer&) {
         r.suites[0].episodes = {0, 100};
       }},
      {"EPIS", "shakes its cameras by 6 numbers",
       [](Records& r, Writer& w) {
         r.episodes[0].shaken = w.reals(std::vector<double>{0, 0, 0, 1, 0, 0});
       }},
      {"REAL", "the turn of a camera",
       [](Records& r, Writer& w) {
         r.episodes[0].shaken = w.reals(std::vector<double>{0, 0, 0, 1, 1, 0, 0});
       }},
      {"LIST", "do not ascend",
       [](Records& r, Writer& w) {
         r.suites[0].episodes = w.list(std::vector<std::uint32_t>{2, 0});
       }},
      {"SUIT", "runs no episode",
       [](Records& r, Writer& w) {
         r.suites[0].episodes = w.list(std::vector<std::uint32_t>{0, 1});
       }},
      {"SPAN", "span kind", [](Records& r, Writer&) { r.spans[0].what = 6; }},
      {"SPAN", "spans ascend", [](Records& r, Writer&) { std::ranges::reverse(r.spans); }},
      {"SPAN", "no part of a text", [](Records& r, Writer&) { r.spans[0].end = 9999; }},
      {"SPAN", "of TEXT", [](Records& r, Writer&) { r.texts.clear(); }},
      {"TEXT", "of TXTB", [](Records& r, Writer&) { r.texts[0].bytes.count += 1; }},
      {"TEXT", "path of a text", [](Records& r, Writer&) { r.texts[0].path.length = 0xffffffff; }},
  };
}

inline std::vector<Defect> code_defects() {
  const auto patch = [](std::size_t i, Instruction in) {
    return [i, in](Records& r, Writer&) { r.code[i] = in; };
  };
  using enum Op;
  return {
      {"CODE", "operation 0xee", [](Records& r, Writer&) { r.code[0].op = 0xee; }},
      {"CODE", "second byte", [](Records& r, Writer&) { r.code[0].zero = 1; }},
      {"CODE", "3 results before it", [](Records& r, Writer&) { r.code[3].dst = 4; }},
      {"CODE", "ends with END", patch(18, make_instruction(kTCP, 15))},
      {"CODE", "END is the last", patch(4, make_instruction(kEND, 4))},
      {"CODE", "unused operand", patch(1, make_instruction(kTCP, 1, 1))},
      {"CODE", "before it is written", patch(2, make_instruction(kVSUB, 2, 0, 2))},
      {"CODE", "before it is written", patch(2, make_instruction(kVSUB, 2, 0xffff, 1))},
      {"CODE", "wants a vector but r3 is a number", patch(5, make_instruction(kVLEN, 5, 3))},
      {"CODE", "reads constant 4 of 4", patch(4, make_instruction(kKR, 4, 4))},
      {"CODE", "reads constant 4 of 4", patch(9, make_instruction(kKV, 8, 2))},
      {"CODE", "at most 1", patch(16, make_instruction(kKB, 13, 2))},
      {"CODE", "at most 2", patch(17, make_instruction(kAXIS, 14, 0, 3))},
      {"CODE", "a task has at most 256", patch(0, make_instruction(kPOS, 0, 300))},
      {"CODE", "names body 6, but task `carrot_on_plate` has 6",
       patch(0, make_instruction(kPOS, 0, 6))},
      {"CODE", "is no finger", patch(8, make_instruction(kOPEN, 7, 5))},
      {"CODE", "uses state 2 of 2", patch(6, make_instruction(kONCE, 6, 5, 2))},
      {"CODE", "not of kind ALWAYS", patch(6, make_instruction(kALWAYS, 6, 5, 0))},
      {"CODE", "one monitor, not to two",
       [](Records& r, Writer&) {
         r.states[1] = r.states[0], r.code[14] = make_instruction(kONCE, 12, 11, 0);
       }},
      {"CODE", "names metric 3 of 3", patch(7, make_instruction(kEMITB, 7, 6, 3))},
      {"CODE", "not twice", patch(15, make_instruction(kEMITB, 13, 12, 0))},
      {"CODE", "type of metric", patch(7, make_instruction(kEMITB, 7, 6, 1))},
      {"METR", "exactly once",
       [](Records& r, Writer& w) {
         r.metrics.push_back({w.text("more"), 1, 1}), r.programs[0].metrics.count = 4;
       }},
      {"STAT", "belongs to one monitor",
       [](Records& r, Writer&) {
         r.states.push_back(r.states[0]), r.programs[0].states.count = 3;
       }},
      {"PROG", "at most 4096",
       [](Records& r, Writer&) { r.code.resize(5000), r.programs[0].code.count = 5000; }},
      {"PROG", "at least its END",
       [](Records& r, Writer&) {
         r.programs.push_back(ProgramRecord{}), r.programs[1].code.first = 19;
       }},
  };
}

inline std::vector<Defect> identity_defects() {
  return {
      {"PROG", "program hash", [](Records& r, Writer&) { r.programs[0].hash[0] ^= 1; }},
      {"TASK", "judge id", [](Records& r, Writer&) { r.tasks[1].judge_id[0] ^= 1; }},
      {"EPIS", "start id", [](Records& r, Writer&) { r.episodes[2].start_id[31] ^= 1; }},
      {"EPIS", "episode id", [](Records& r, Writer&) { r.episodes[2].episode_id[31] ^= 1; }},
      {"EPIS", "episode id", [](Records& r, Writer& w) { r.tasks[0].prompt = w.text("drop it"); }},
  };
}

}  // namespace probe::plan
