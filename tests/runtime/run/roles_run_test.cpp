// Tasks with one thing, with two and with a set, from their text to their results: what the expert
// can do it does, and what it has no skill for is a status of its own.
#include <doctest/doctest.h>

#include <array>

#include "runtime/plan/roles.h"
#include "runtime/rejudge/tally.h"
#include "runtime/run/replay.h"
#include "runtime/stage/goal.h"
#include "runtime/store/not_attempted.h"
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
  CHECK(summary.invalid + summary.not_attempted.count() == 0);
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

TEST_CASE("a set is put into a basket side by side, and nothing on what lies there") {
  TemporaryFolder folder;
  const RunSummary summary =
      must_run(roles_plan(), one_start(folder / "run", "expert", "cubes_in_basket"));
  CHECK(summary.invalid + summary.not_attempted.count() == 0);
  const auto rows = read_results(folder / "run");
  REQUIRE(rows.ok());
  for (const MetricValue& metric : rows->front().metrics) {
    if (metric.name == "success") CHECK(metric.value == 1);
  }
}

// What no skill does with things that no role of the expert's is filled with.
const plan::Plan& toppling_plan() {
  static const plan::Plan plan = plan_of_text(R"(use "examples/roles.probe"
metrics toppled { success = at end all g in goods: angle(axis_z(g), up) > 60deg }
task topple {
  scene table; layout around; metrics toppled; horizon 60 steps
  goods green_cube, yellow_cube, blue_cube; say "topple {all three goods}"
}
suite mine trained on bridge_v2 { tasks { topple }; seeds 42 }
)");
  return plan;
}

TEST_CASE("what the expert has no skill for is not attempted: neither invalid nor failed") {
  TemporaryFolder folder;
  const RunOptions options = one_start(folder / "run", "expert", "topple");
  const RunSummary summary = must_run(toppling_plan(), options);
  CHECK(summary.done == 1);
  CHECK(summary.not_attempted.count() == 1);
  CHECK(store::to_text(summary.not_attempted) == "no solution in skills for this goal");
  CHECK(summary.invalid == 0);
  const auto rows = read_results(folder / "run");
  REQUIRE(rows.ok());
  for (const ResultRow& row : *rows) {
    CHECK(is_not_attempted(row));
    CHECK(row.invalid == "not attempted: no solution in skills for this goal");
  }
  const std::string tally = rejudge::tally_text(*rows, &toppling_plan());
  CHECK(tally.find("topple: 1 episodes, 1 not attempted (no solution in skills for this goal)") !=
        std::string::npos);
  CHECK(tally.find("invalid") == std::string::npos);
  // Asking again would change nothing.
  const RunSummary again = must_run(toppling_plan(), options);
  CHECK(again.done == 0);
  CHECK(again.skipped == 1);
}

TEST_CASE("where actions are late, that is the reason, and not that there is no solution") {
  TemporaryFolder folder;
  const plan::Plan late = plan_of_text(R"(use "examples/roles.probe"
variant late of pick_can { delay 2 steps }
suite mine trained on bridge_v2 { tasks { pick_can, late }; seeds 42 }
)");
  const RunSummary summary = must_run(late, one_start(folder / "run", "expert", "late"));
  CHECK(summary.invalid == 0);
  CHECK(summary.not_attempted.count() == 1);
  CHECK(store::to_text(summary.not_attempted) == "the expert does not plan ahead of late actions");
}

// Fails as policies of users do, in words that ours might have said.
class Unskilled final : public policy::Policy {
 public:
  Status begin(const policy::EpisodeStart&) override {
    return Failure{Fault::kPolicy, "skill library is empty", ""};
  }
  Result<policy::Action> act(const policy::Observation&) override {
    return policy::Action{0, 0, 0, 0, 0, 0, 1};
  }
};

TEST_CASE("what a policy of somebody else says, in whatever words, makes an episode invalid") {
  TemporaryFolder folder;
  RunOptions options = one_start(folder / "run", "theirs", "pick_can");
  options.own_policy =
      OwnPolicy{{}, [](const PolicyContext&) -> Result<std::unique_ptr<policy::Policy>> {
                  return std::unique_ptr<policy::Policy>(std::make_unique<Unskilled>());
                }};
  const RunSummary summary = must_run(roles_plan(), options);
  CHECK(summary.invalid == 1);
  CHECK(summary.not_attempted.count() == 0);
  CHECK(read_results(folder / "run")->front().invalid == "policy: skill library is empty");
}

TEST_CASE("scripted policies run through tasks that lack what they go for") {
  TemporaryFolder folder;
  for (const char* policy : {"null", "wrong"}) {
    CAPTURE(policy);
    const RunSummary summary =
        must_run(toppling_plan(), one_start(folder / policy, policy, "topple"));
    CHECK(summary.done == 1);
    CHECK(summary.invalid + summary.not_attempted.count() == 0);
  }
  const RunSummary reach =
      must_run(toppling_plan(), one_start(folder / "reach", "reach", "topple"));
  CHECK(reach.not_attempted.count() == 1);
}

}  // namespace
}  // namespace probe::run
