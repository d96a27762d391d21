// What is said, how long, by which comparison and in which category: the suite against the released
// list. Also what a suite of the paper is: its tasks, prefix and seeds.
#include <doctest/doctest.h>

#include "tests/parity/published.h"

using namespace probe;

namespace {

std::string full_name(const plan::Plan& plan, std::uint32_t task) {
  return "widowx_" + std::string(plan.text(plan.tasks()[task].name));
}

std::vector<std::string> members(const plan::Plan& plan, std::string_view set) {
  std::vector<std::string> names;
  for (const plan::SetRecord& record : plan.sets()) {
    if (plan.text(record.name) != set) continue;
    for (const std::uint32_t task : plan::slice_of(plan.tables().list, record.members))
      names.push_back(full_name(plan, task));
  }
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace

TEST_CASE("instructions, horizons, roles and canonical tasks equal the published ones") {
  const test::Published* released = test::published();
  if (released == nullptr) return;
  const plan::Plan& plan = test::suite_plan();
  std::size_t prompts = 0, horizons = 0, roles = 0, canonical = 0;
  for (std::uint32_t t = 0; t < plan.tasks().size(); ++t) {
    const plan::TaskRecord& task = plan.tasks()[t];
    const std::string name(plan.text(task.name));
    CAPTURE(name);
    const Json* entry = released->find(name);
    REQUIRE(entry != nullptr);
    CHECK(plan.text(task.prompt) == (*entry)["instruction"].get<std::string>());
    prompts += plan.text(task.prompt) == (*entry)["instruction"].get<std::string>();
    CHECK(task.horizon == (*entry)["max_control_steps"].get<std::uint32_t>());
    horizons += task.horizon == (*entry)["max_control_steps"].get<std::uint32_t>();
    std::vector<std::string> want = {(*entry)["source"].text(), (*entry)["target"].text()}, have;
    for (const auto& other : (*entry)["distractors"]) want.push_back(other.text());
    for (const plan::BodyRecord& body : plan::slice_of(plan.tables().bodies, task.bodies)) {
      if (body.kind == static_cast<std::uint32_t>(plan::BodyKind::kObject))
        have.emplace_back(plan.text(plan.objects()[body.index].name));
    }
    CHECK(have == want);
    roles += have == want;
    const std::string baseline = full_name(plan, task.baseline == plan::kNone ? t : task.baseline);
    CHECK(baseline == (*entry)["canonical"].get<std::string>());
    canonical += baseline == (*entry)["canonical"].get<std::string>();
  }
  MESSAGE("equal to the published: " << prompts << " instructions, " << horizons << " horizons, "
                                     << roles << " lists of objects, " << canonical
                                     << " canonical tasks");
  CHECK(plan.tasks().size() == 51);
}

TEST_CASE("the eleven categories are computed as published") {
  const test::Published* released = test::published();
  if (released == nullptr) return;
  const plan::Plan& plan = test::suite_plan();
  std::map<std::string, std::vector<std::string>> want;
  for (const auto& entry : released->tasks) want[entry["category"].text()].push_back(entry["name"].text());
  std::string counts;
  std::size_t tasks = 0;
  for (auto& [category, names] : want) {
    std::sort(names.begin(), names.end());
    CAPTURE(category);
    CHECK(members(plan, category == "original" ? "core" : category) == names);
    counts += (counts.empty() ? "" : ", ") + category + " " + std::to_string(names.size());
    tasks += names.size();
  }
  MESSAGE(want.size() << " categories: " << counts);
  CHECK(want.size() == 11);
  CHECK(tasks == 51);
}

TEST_CASE("the first suite is the published one with its three seeds") {
  const plan::Plan& plan = test::suite_plan();
  REQUIRE(!plan.suites().empty());
  const plan::SuiteRecord& suite = plan.suites()[0];
  CHECK(plan.text(suite.name) == "intact");
  CHECK(plan.text(suite.prefix) == "widowx_");
  CHECK(plan.text(suite.trained_on) == "bridge_v2");
  CHECK(suite.members.count == 50);
  const auto seeds = plan::slice_of(plan.tables().list, suite.seeds);
  CHECK(std::vector<std::uint32_t>(seeds.begin(), seeds.end()) ==
        std::vector<std::uint32_t>{42, 7, 314});
}
