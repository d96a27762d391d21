// Which interval a rate of an adaptive folder has.
#include "runtime/adaptive/sampled.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <vector>

namespace probe::adaptive {
namespace {

AdaptiveRun run_of(Rule::Kind kind, int tasks, int starts, const std::vector<int>& seeds = {42}) {
  AdaptiveRun run;
  run.rule.kind = kind;
  run.rule.points = 10;
  run.rule.against = "old";
  run.rule.outcomes = "0";
  run.drawing = stats::Drawing::kInTurn;
  for (int start = 0; start < starts; ++start) {
    for (int task = 0; task < tasks; ++task) {
      for (const int seed : seeds) run.order.push_back({{"t" + std::to_string(task), start, seed}, {}});
    }
  }
  if (kind == Rule::Kind::kDecided)
    for (auto& one : run.order) one.other = false;
  return run;
}

store::ResultRow row_of(const std::string& task, int start, bool success, int seed = 42) {
  store::ResultRow row;
  row.task = task;
  row.episode = start;
  row.seed = seed;
  row.metrics = {{"success", true, success ? 1.0 : 0.0}};
  return row;
}

}  // namespace

TEST_CASE("rows behind a gap do not count, of the task alone where each stops by itself") {
  const AdaptiveRun each = run_of(Rule::Kind::kEachTask, 2, 3), all = run_of(Rule::Kind::kAllTasks, 2, 3);
  const std::vector<bool> rows = {true, true, false, true, true, true};
  CHECK(counted_places(each, rows) == std::vector<bool>{true, true, false, true, false, true});
  CHECK(counted_places(all, rows) == std::vector<bool>{true, true, false, false, false, false});
}

TEST_CASE("a rate over tasks is what a run of all would find, not what unlike shares of them did") {
  const AdaptiveRun run = run_of(Rule::Kind::kEachTask, 2, 24);
  Summarizer sums(run);
  for (int start = 0; start < 24; ++start) sums.add(row_of("t0", start, start % 2 == 0));
  for (int start = 0; start < 8; ++start) sums.add(row_of("t1", start, true));
  const Summary summary = sums.summary();
  CHECK(summary.counted == 32);
  CHECK(summary.planned == 48);
  REQUIRE(summary.all);
  CHECK(summary.all->rate == doctest::Approx(0.75));
  CHECK(summary.tasks[0].rate->interval.low == doctest::Approx(0.5));
  CHECK(summary.tasks[0].rate->interval.high == doctest::Approx(0.5));
  CHECK(summary.tasks[1].rate->interval.high == doctest::Approx(1));
  CHECK(summary.all->interval.low < 0.75);
  CHECK(summary.all->interval.high == doctest::Approx(0.75));
  CHECK(to_lines(summary)[0].find("32 of 48 episodes count") != std::string::npos);
}

TEST_CASE("what was not attempted is no part of a rate, which is known of whole tasks alone") {
  const AdaptiveRun run = run_of(Rule::Kind::kEachTask, 1, 6);
  const auto with = [&](int rows) {
    Summarizer sums(run);
    for (int start = 0; start < rows; ++start) {
      store::ResultRow row = row_of("t0", start, true);
      if (start == 1) row.invalid = "not attempted: no solution";
      sums.add(row);
    }
    return sums.summary();
  };
  CHECK_FALSE(with(5).tasks[0].rate);
  CHECK_FALSE(with(5).all);
  REQUIRE(with(6).tasks[0].rate);
  CHECK(with(6).tasks[0].rate->interval.low == doctest::Approx(1));
}

TEST_CASE("seeds that were drawn together are lists of their own, each with its part of the error") {
  const AdaptiveRun one = run_of(Rule::Kind::kDecided, 1, 60);
  const AdaptiveRun three = run_of(Rule::Kind::kDecided, 1, 60, {1, 2, 3});
  Summarizer alone(one), together(three);
  for (int start = 0; start < 30; ++start) {
    alone.add(row_of("t0", start, start % 2 == 0));
    for (const int seed : {1, 2, 3}) together.add(row_of("t0", start, start % 2 == 0, seed));
  }
  const stats::Interval a = alone.summary().all->interval, b = together.summary().all->interval;
  // Three seeds of a start that end alike are no more than one.
  CHECK(b.low <= a.low);
  CHECK(b.high >= a.high);
  CHECK(together.summary().decision->starts() == 30);
  CHECK(together.summary().decision->won() == 15);
}

TEST_CASE("why nothing of a fixed number is said of a rule's run, and of a search's") {
  CHECK(why_not_fixed("width 10 % of each task").find("(--until: width 10 % of each task)") !=
        std::string::npos);
  const std::string search = why_not_fixed(std::string(store::kBySearch));
  CHECK(search.find("--until") == std::string::npos);
  CHECK(search.find("a search chose its episodes by what it found, which tests") == 0);
}

}  // namespace probe::adaptive
