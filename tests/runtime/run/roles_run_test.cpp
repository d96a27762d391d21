// Tasks with one thing, with two and with a set, from their text to their results: what the expert
// can do it does, and what it has no skill for is a status of its own.
#include <doctest/doctest.h>

#include <array>

#include "runtime/plan/roles.h"
#include "runtime/rejudge/tally.h"
#include "runtime/run/replay.h"
#include "runtime/stage/goal.h"
#include "tests/runtime/run/plan_of_text.h"
#include "tests/runtime/run/run_checks.h"
#include "tests/runtime/run/temporary_folder.h"

namespace probe::run {
namespace {

const plan::Plan& roles_plan() {
  static const plan::Plan plan =
      plan_of_file(std::string(VLAPROBE_SOURCE_DIR) + "/examples/roles.probe");
  return plan;
}

RunOptions one_start(const std::string& out, const std::string& policy, const std::string& tasks) {
  RunOptions options = options_for(out, policy);
  options.tasks = tasks;
  options.episodes = {0, 0};
  return options;
}

TEST_CASE("what a task asks for is found where it has no target, a helper or a set") {
  const plan::Plan& plan = roles_plan();
  const std::pair<const char*, policy::Goal> wanted[] = {
      {"pick_can", policy::Goal::kLifted},
      {"carrot_and_spoon_on_plate", policy::Goal::kOther},
      {"cubes_in_basket", policy::Goal::kOther}};
  for (const auto& [task, goal] : wanted) {
    CAPTURE(task);
    const auto found = stage::goal_of(plan, plan.find_task(task).value());
    REQUIRE(found.ok());
    CHECK(*found == goal);
  }
}

TEST_CASE("a can is picked up without a target, judged and repeated bit for bit") {
  TemporaryFolder folder;
  const RunOptions options = one_start(folder / "run", "expert", "pick_can");
  const RunSummary summary = must_run(roles_plan(), options);
  CHECK(summary.done == 1);
  CHECK(summary.invalid + summary.not_attempted == 0);
  const auto rows = read_results(folder / "run");
  REQUIRE(rows.ok());
  for (const MetricValue& metric : rows->front().metrics) {
    if (metric.name == "success") CHECK(metric.value == 1);
  }
  ReplayOptions replaying;
  replaying.verify = true;
  replaying.assets = options.assets;
  const auto again = replay(folder / "run", "pick_can", 0, std::nullopt, replaying);
  REQUIRE_MESSAGE(again.ok(), to_text(again.failure()));
  CHECK_MESSAGE(again->identical, again->difference);
}

TEST_CASE("what the expert has no skill for is not attempted: neither invalid nor failed") {
  TemporaryFolder folder;
  const RunOptions options = one_start(folder / "run", "expert", "cubes_in_basket");
  const RunSummary summary = must_run(roles_plan(), options);
  CHECK(summary.done == 1);
  CHECK(summary.not_attempted == 1);
  CHECK(summary.invalid == 0);
  const auto rows = read_results(folder / "run");
  REQUIRE(rows.ok());
  for (const ResultRow& row : *rows) {
    CHECK(is_not_attempted(row));
    CHECK(row.invalid == "not attempted: no solution in skills for this goal");
  }
  const std::string tally = rejudge::tally_text(*rows, &roles_plan());
  CHECK(tally.find("cubes_in_basket: 1 episodes, 1 not attempted (no solution in skills for this "
                   "goal)") != std::string::npos);
  CHECK(tally.find("invalid") == std::string::npos);
  // Asking again would change nothing.
  const RunSummary again = must_run(roles_plan(), options);
  CHECK(again.done == 0);
  CHECK(again.skipped == 1);
}

TEST_CASE("scripted policies run through tasks that lack what they go for") {
  TemporaryFolder folder;
  for (const char* policy : {"null", "wrong"}) {
    CAPTURE(policy);
    const RunSummary summary =
        must_run(roles_plan(), one_start(folder / policy, policy, "cubes_in_basket"));
    CHECK(summary.done == 1);
    CHECK(summary.invalid + summary.not_attempted == 0);
  }
  const RunSummary reach =
      must_run(roles_plan(), one_start(folder / "reach", "reach", "cubes_in_basket"));
  CHECK(reach.not_attempted == 1);
}

}  // namespace
}  // namespace probe::run
