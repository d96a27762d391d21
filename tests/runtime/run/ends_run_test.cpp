// Episodes that end when a condition holds, and that begin behind steps of standing still: from
// their text to results, replay and judging again.
#include <doctest/doctest.h>

#include <string>

#include "runtime/rejudge/explain.h"
#include "runtime/rejudge/rejudge.h"
#include "runtime/run/replay.h"
#include "runtime/store/proof.h"
#include "runtime/store/store.h"
#include "runtime/store/stored_trace.h"
#include "tests/runtime/run/plan_of_text.h"
#include "tests/runtime/run/run_checks.h"
#include "tests/runtime/run/temporary_folder.h"

namespace probe::run {
namespace {

const char* const kText = R"(use "suite/intact.probe"
metrics lifting like put_strict { ends when height(source) > 90cm }
task whole like carrot_on_plate { horizon 30 steps }
task ending like whole { metrics lifting }
task still like whole { idle 4 steps; horizon 6 steps }
task at_once like still { idle 0 steps }
)";

plan::Plan plan_of(const std::string& task) {
  return plan_of_text(std::string(kText) + "suite mine trained on bridge_v2 { tasks { " + task +
                      " }; seeds 42 }\n");
}

ResultRow row_of(const plan::Plan& plan, const std::string& out, const std::string& policy) {
  RunOptions options = options_for(out, policy);
  options.episodes = {0, 0};
  const RunSummary summary = must_run(plan, options);
  CHECK(summary.invalid == 0);
  const auto proven = store::read_proven_results(out);
  REQUIRE_MESSAGE(proven.ok(), to_text(proven.failure()));
  CHECK_MESSAGE(proven->refused.empty(), proven->refused.front());
  REQUIRE(proven->rows.size() == 1);
  return proven->rows.front();
}

double metric(const ResultRow& row, const std::string& name) {
  for (const MetricValue& value : row.metrics) {
    if (value.name == name) return value.value;
  }
  FAIL("no metric " << name);
  return 0;
}

void check_repeats(const std::string& dir, const std::string& task) {
  ReplayOptions replaying;
  replaying.verify = true;
  replaying.assets = options_for("").assets;
  const auto again = replay(dir, task, 0, std::nullopt, replaying);
  REQUIRE_MESSAGE(again.ok(), to_text(again.failure()));
  CHECK_MESSAGE(again->identical, again->difference);
}

TEST_CASE("an episode ends with the first step at which its condition holds") {
  TemporaryFolder folder;
  const plan::Plan ending = plan_of("ending"), whole = plan_of("whole");
  const ResultRow cut = row_of(ending, folder / "ending", "expert");
  const ResultRow full = row_of(whole, folder / "whole", "expert");
  CHECK(full.steps == 30);
  CHECK(cut.steps > 1);
  CHECK(cut.steps < 30);
  CHECK(metric(cut, "ended") == 1);
  CHECK(results_to_csv(std::span(&cut, 1)).find(",ended,") != std::string::npos);
  check_repeats(folder / "ending", "ending");

  const auto trace = store::read_stored_trace(cut);
  REQUIRE(trace.ok());
  const std::uint32_t ended = ending.ends_metric(ending.tasks()[0]).value();
  for (std::size_t i = 0; i < trace->steps.size(); ++i)
    CHECK((trace->steps[i].metrics[ended] != 0) == (i + 1 == trace->steps.size()));

  const auto why = rejudge::why(folder / "ending", "ending", 0, std::nullopt, "ended");
  REQUIRE_MESSAGE(why.ok(), to_text(why.failure()));
  CHECK(why->metrics.at(0).readout == "ends when");
  CHECK(why->metrics.at(0).step == cut.steps);
}

TEST_CASE("a condition that never holds ends nothing") {
  TemporaryFolder folder;
  const ResultRow row = row_of(plan_of("ending"), folder / "run", "null");
  CHECK(row.steps == 30);
  CHECK(metric(row, "ended") == 0);
}

TEST_CASE("a whole episode is judged up to where it ends; one that ended is too short to go on") {
  TemporaryFolder folder;
  // Tasks of one name: their starts are the same, what is judged is not.
  const plan::Plan ending = plan_of("ending"), whole = plan_of("whole");
  row_of(whole, folder / "whole", "expert");
  const ResultRow cut = row_of(ending, folder / "ending", "expert");
  const auto trace = store::read_stored_trace(cut);
  REQUIRE(trace.ok());
  const auto long_trace = store::find_trace(folder / "whole", "whole", 0, std::nullopt);
  REQUIRE(long_trace.ok());
  const auto judged = rejudge::explain(ending, 0, long_trace->trace, "ended");
  REQUIRE_MESSAGE(judged.ok(), to_text(judged.failure()));
  CHECK(judged->at(0).step == cut.steps);
  const auto refused = rejudge::explain(whole, 0, *trace);
  REQUIRE(!refused.ok());
  CHECK(refused.failure().message ==
        "it has " + std::to_string(cut.steps) + " steps, task `whole` judges 30");
}

TEST_CASE("steps of standing still come before the first: another start, the same length") {
  TemporaryFolder folder;
  const plan::Plan still = plan_of("still"), at_once = plan_of("at_once");
  const ResultRow row = row_of(still, folder / "still", "null");
  const ResultRow other = row_of(at_once, folder / "at_once", "null");
  CHECK(row.steps == 6);
  CHECK(row.start_id != other.start_id);
  check_repeats(folder / "still", "still");
  const auto late = store::read_stored_trace(row), early = store::read_stored_trace(other);
  REQUIRE(late.ok());
  REQUIRE(early.ok());
  CHECK(late->start->sample.step == 0);
  CHECK(late->start->sample.time == 0);
  CHECK(late->start->state_hash != early->start->state_hash);
  CHECK(late->steps[0].sample.step == 1);
  // A policy that does nothing goes on with what idling did: opening the gripper apart.
  for (std::size_t j = 0; j + 2 < late->start->q.size(); ++j)
    CHECK(late->start->q[j] == doctest::Approx(early->steps[1].q[j]).epsilon(0.05));
}

}  // namespace
}  // namespace probe::run
