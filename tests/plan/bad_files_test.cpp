// Every rule of the verifier is broken by a file that is kept: tests/plan/bad-RULE.hex.
// VLAPROBE_UPDATE=1 writes the files again from the defects; review the difference.
#include <doctest/doctest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <set>

#include "runtime/plan/plan.h"
#include "tests/plan/defects.h"
#include "tests/plan/fixture_defects.h"
#include "tests/plan/hex.h"
#include "tests/plan/question_defects.h"
#include "tests/plan/robot_defects.h"
#include "tests/plan/rule_of.h"

using namespace probe;
using namespace probe::plan;

namespace {

namespace fs = std::filesystem;
using Bytes = std::vector<std::byte>;

const fs::path kFolder = VLAPROBE_SOURCE_DIR "/tests/plan";

std::string read_text(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

Bytes with_defect(const std::function<void(Records&, Writer&)>& make, Writer w = small_writer()) {
  std::ranges::reverse(w.records.spans);
  w.fill_ids();
  make(w.records, w);
  return w.lay_out();
}

Bytes with_envelope(const std::function<void(Header&, std::vector<DirectoryEntry>&)>& make) {
  Bytes bytes = small_plan();
  Header header = read_header(bytes);
  auto directory = read_directory(bytes);
  make(header, directory);
  std::memcpy(bytes.data(), &header, sizeof header);
  std::memcpy(bytes.data() + sizeof header, directory.data(),
              directory.size() * sizeof(DirectoryEntry));
  return bytes;
}

// What no table of defects has, since it takes bytes or many records.
std::vector<Bytes> other_defects() {
  std::vector<Bytes> all;
  Bytes bytes = small_plan();
  all.emplace_back(bytes.begin(), bytes.begin() + 63);
  bytes[read_directory(bytes)[0].offset + read_directory(bytes)[0].size] = std::byte{1};
  all.push_back(bytes);
  const std::vector<std::function<void(Records&, Writer&)>> many = {
      [](Records& r, Writer& w) {
        r.robots[0].meshes = w.list(std::vector<std::uint32_t>(kMaxMeshes + 1, 0));
      },
      [](Records& r, Writer&) {
        r.suns.resize(kMaxSuns + 1, r.suns[0]);
        r.lights[0].suns = {0, kMaxSuns + 1};
      },
      [](Records& r, Writer&) {
        r.constants.assign(kMaxConstants + 1, 0.0);
        r.programs[0].constants = {0, kMaxConstants + 1};
      },
      [](Records& r, Writer&) {
        r.metrics.resize(kMaxMetrics + 1, r.metrics[0]);
        r.programs[0].metrics = {0, kMaxMetrics + 1};
      },
      [](Records& r, Writer&) {
        r.programs[0].states = {1, 1};
      },
      [](Records& r, Writer&) { r.bodies[2].index = 1; },
      [](Records& r, Writer&) { r.tasks[0].source = 1, r.tasks[0].target = 0; },
      [](Records& r, Writer&) { r.bodies[1].index = 0; },
      [](Records& r, Writer&) { r.cameras[0].aim_values[3] = 1; },
      [](Records& r, Writer&) { r.suns[0].zero = 1; },
      [](Records& r, Writer&) { r.tasks[0].drop = -1; },
  };
  for (const auto& make : many) all.push_back(with_defect(make));
  return all;
}

// For each rule the smallest file that breaks it.
std::map<std::string, Bytes> bad_plans() {
  std::vector<Bytes> all = other_defects();
  for (const EnvelopeDefect& defect : envelope_defects()) all.push_back(with_envelope(defect.make));
  for (const auto& defects :
       {catalogue_defects(), task_defects(), code_defects(), identity_defects()}) {
    for (const Defect& defect : defects) all.push_back(with_defect(defect.make));
  }
  for (const Defect& defect : question_defects())
    all.push_back(with_defect(defect.make, question_writer()));
  for (const Defect& defect : fixture_defects())
    all.push_back(with_defect(defect.make, fixture_writer()));
  for (const Defect& defect : robot_defects())
    all.push_back(with_defect(defect.make, robot_writer()));
  std::map<std::string, Bytes> plans;
  for (Bytes& bytes : all) {
    const Status status = verify(bytes);
    if (status.ok()) continue;
    const RuleInfo* rule = rule_of(status.failure());
    REQUIRE_MESSAGE(rule != nullptr, status.failure().message);
    const auto [known, is_new] = plans.try_emplace(std::string(rule->id), bytes);
    if (!is_new && bytes.size() < known->second.size()) known->second = std::move(bytes);
  }
  return plans;
}

void write_files() {
  for (const auto& [id, bytes] : bad_plans()) {
    const Failure failure = verify(bytes).failure();
    std::ofstream(kFolder / ("bad-" + id + ".hex"), std::ios::binary)
        << "# " << rule_of(failure)->statement << "\n# where: " << failure.where
        << "\n# message: " << failure.message << "\n"
        << to_hex_dump(bytes);
  }
}

std::string comment(const std::string& text, const std::string& key) {
  const std::size_t at = text.find("# " + key + ": ");
  if (at == std::string::npos) return "";
  const std::size_t begin = at + key.size() + 4;
  return text.substr(begin, text.find('\n', begin) - begin);
}

}  // namespace

TEST_CASE(
    "every rule of the verifier has a kept file that it refuses, saying section, byte and rule") {
  if (std::getenv("VLAPROBE_UPDATE") != nullptr) write_files();
  std::size_t refused = 0;
  for (const RuleInfo& rule : all_rules()) {
    const fs::path path = kFolder / ("bad-" + std::string(rule.id) + ".hex");
    CAPTURE(path);
    const std::string text = read_text(path);
    CHECK_MESSAGE(!text.empty(), "no file breaks the rule: ", rule.statement);
    const auto bytes = from_hex_dump(text);
    if (text.empty()) continue;
    REQUIRE(bytes.has_value());
    const Status status = verify(*bytes);
    REQUIRE(!status.ok());
    const Failure& failure = status.failure();
    CHECK(failure.code == Fault::kPlan);
    CHECK(failure.where == comment(text, "where"));
    CHECK(failure.message == comment(text, "message"));
    CHECK(failure.where.find(" at byte ") != std::string::npos);
    const RuleInfo* named = rule_of(failure);
    REQUIRE(named != nullptr);
    CHECK(named->id == rule.id);
    const auto opened = Plan::from_bytes(*bytes);
    REQUIRE(!opened.ok());
    CHECK(opened.failure().message == failure.message);
    ++refused;
  }
  MESSAGE(refused << " kept files, each refused by its own rule");
}

TEST_CASE("no kept file is without a rule") {
  std::set<std::string> known;
  for (const RuleInfo& rule : all_rules()) known.insert("bad-" + std::string(rule.id) + ".hex");
  for (const auto& entry : fs::directory_iterator(kFolder)) {
    if (entry.path().extension() != ".hex") continue;
    CHECK_MESSAGE(known.contains(entry.path().filename().string()), entry.path().string());
  }
}

TEST_CASE("a dump gives back the bytes it was made of") {
  const Bytes bytes = small_plan();
  const std::string text = to_hex_dump(bytes);
  const auto again = from_hex_dump(text);
  REQUIRE(again.has_value());
  CHECK(*again == bytes);
  CHECK(!from_hex_dump(text.substr(0, text.size() / 2)));
  CHECK(text.find("# STRS\n") != std::string::npos);
}

TEST_CASE("a plan with laws, gears and more fingers is good, and each defect of them is named") {
  Writer good = robot_writer();
  const auto bytes = good.finish();
  REQUIRE_MESSAGE(bytes.ok(), (bytes.ok() ? "" : to_text(bytes.failure())));
  for (const Defect& defect : robot_defects()) {
    CAPTURE(std::string(defect.rule));
    const Status status = verify(with_defect(defect.make, robot_writer()));
    CHECK(!status.ok());
    if (status.ok()) continue;
    CAPTURE(status.failure().message);
    CHECK(status.failure().message.find(defect.rule) != std::string::npos);
    CHECK(status.failure().where.find(defect.section) != std::string::npos);
  }
}
