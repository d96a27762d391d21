// Which episode is next, and whether what is counted of it keeps its promise when episodes end out of
// turn: made-up runs with known truth.
#include "runtime/adaptive/chooser.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <map>
#include <queue>
#include <random>
#include <vector>

#include "runtime/adaptive/sampled.h"
#include "runtime/stats/sequential.h"

namespace probe::adaptive {
namespace {

Rule width(double points, Rule::Kind kind = Rule::Kind::kEachTask) {
  Rule rule;
  rule.kind = kind;
  rule.points = points;
  return rule;
}

Rule decided() {
  Rule rule;
  rule.kind = Rule::Kind::kDecided;
  rule.against = "old";
  rule.outcomes = "0";
  return rule;
}

std::vector<Planned> order_of(std::uint32_t tasks, std::uint32_t starts) {
  std::vector<Planned> order;
  for (std::uint32_t start = 0; start < starts; ++start) {
    for (std::uint32_t task = 0; task < tasks; ++task) order.push_back({task, start});
  }
  return order;
}

// Runs one episode after the other; how many were run of each task.
template <typename Ends>
std::map<std::uint32_t, int> run_all(Chooser& chooser, Ends&& ends) {
  std::map<std::uint32_t, int> run;
  while (const auto place = chooser.next()) {
    ++run[chooser.order()[*place].task];
    chooser.tell(*place, ends(chooser.order()[*place]));
  }
  CHECK(chooser.under_way() == 0);
  return run;
}

Outcome as(bool success) { return success ? Outcome::kSuccess : Outcome::kFailure; }

double uniform(std::mt19937& bits) { return static_cast<double>(bits()) / 4294967296.0; }

// `workers` worlds; an episode that fails takes a tenth of the time. What is counted of each task when
// none is under way, or when the power goes at a time drawn beforehand.
struct Ended {
  std::vector<stats::Drawn> tasks;
  double plain = 0, rows = 0;  // the successes of all that had ended, whatever was before them
};
Ended run_in_time(const Rule& rule, const std::vector<std::vector<bool>>& truths, int workers,
                  double power_goes) {
  const auto tasks = static_cast<std::uint32_t>(truths.size());
  const auto starts = static_cast<std::uint32_t>(truths[0].size());
  Chooser chooser(rule, order_of(tasks, starts));
  using Event = std::pair<double, std::size_t>;
  std::priority_queue<Event, std::vector<Event>, std::greater<>> under_way;
  double now = 0;
  for (;;) {
    while (static_cast<int>(under_way.size()) < workers) {
      const auto place = chooser.next();
      if (!place) break;
      const Planned& one = chooser.order()[*place];
      under_way.push({now + (truths[one.task][one.start] ? 1.0 : 0.1), *place});
    }
    if (under_way.empty() || under_way.top().first > power_goes) break;
    now = under_way.top().first;
    const std::size_t place = under_way.top().second;
    under_way.pop();
    const Planned& one = chooser.order()[place];
    chooser.tell(place, as(truths[one.task][one.start]));
  }
  Ended out;
  for (std::uint32_t task = 0; task < tasks; ++task) {
    stats::Drawn drawn{starts, 0, 0, 0};
    for (const Planned& one : chooser.order()) {
      if (!has_ended(one.outcome)) continue;
      ++out.rows;
      out.plain += one.outcome == Outcome::kSuccess ? 1 : 0;
    }
    for (const Planned& one : chooser.order()) {
      if (one.task != task) continue;
      if (!has_ended(one.outcome)) break;  // what lies behind it does not count
      ++(one.outcome == Outcome::kSuccess ? drawn.successes : drawn.failures);
    }
    out.tasks.push_back(drawn);
  }
  return out;
}

}  // namespace

TEST_CASE("a policy that always, or never, succeeds is stopped early, with an interval that is right") {
  for (const bool succeeds : {true, false}) {
    Chooser chooser(width(10), order_of(3, 72));
    const auto run = run_all(chooser, [&](const Planned&) { return as(succeeds); });
    for (const auto& [task, count] : run) CHECK(count == 34);
  }
}

TEST_CASE("episodes go to the task that is least sure, and to none that is sure enough") {
  Chooser chooser(width(20), order_of(2, 72));
  std::mt19937 bits(3);
  const auto run = run_all(
      chooser, [&](const Planned& one) { return as(one.task == 0 || uniform(bits) < 0.5); });
  CHECK(run.at(0) < 25);
  CHECK(run.at(1) > 35);
  CHECK(run.at(1) < 72);
}

TEST_CASE("a run that stops is continued by the same choice, in one go or in two") {
  const auto ends = [](const Planned& one) { return as((one.start * 7 + one.task * 3) % 5 < 3); };
  Chooser whole(width(25), order_of(4, 24));
  run_all(whole, ends);
  Chooser first(width(25), order_of(4, 24));
  for (int i = 0; i < 20; ++i) {
    const auto place = first.next();
    first.tell(*place, ends(first.order()[*place]));
  }
  std::vector<Planned> stored = first.order();
  // One is under way when the power goes.
  stored[*first.next()].outcome = Outcome::kAbsent;
  Chooser second(width(25), stored);
  run_all(second, ends);
  for (std::size_t i = 0; i < whole.order().size(); ++i)
    CHECK(second.order()[i].outcome == whole.order()[i].outcome);
}

TEST_CASE("an invalid episode is waited for, done again, and else may have been either") {
  std::vector<Planned> order = order_of(1, 24);
  for (std::size_t i = 0; i < 24; ++i) order[i].outcome = i == 3 ? Outcome::kAbsent : Outcome::kSuccess;
  Chooser chooser(width(10), order);
  REQUIRE(chooser.next() == 3);
  CHECK_FALSE(chooser.next());
  CHECK(chooser.under_way() == 1);
  chooser.tell(3, Outcome::kUnknown);
  CHECK_FALSE(chooser.next());
  CHECK(chooser.under_way() == 0);
  // Told of again: it was another policy's.
  chooser.tell(5, Outcome::kUnknown);
  CHECK_FALSE(chooser.next());
}

TEST_CASE("a task of which an episode is not attempted is run whole") {
  Chooser chooser(width(10), order_of(2, 72));
  const auto run = run_all(chooser, [](const Planned& one) {
    return one.task == 0 && one.start == 5 ? Outcome::kNotAttempted : Outcome::kSuccess;
  });
  CHECK(run.at(0) == 72);
  CHECK(run.at(1) == 34);
}

TEST_CASE("more worlds give a task no more episodes than it seems to need") {
  const auto ended = run_in_time(width(10), std::vector(1, std::vector<bool>(72, true)), 8, 1e9);
  CHECK(ended.tasks[0].drawn() == 34);
}

TEST_CASE("episodes that end out of turn, the failures first, do not bias what is counted") {
  constexpr int kTimes = 2000, kWorkers = 8;
  std::mt19937 bits(11);
  std::map<std::array<std::int64_t, 3>, stats::Interval> known;
  for (const double rate : {0.1, 0.5, 0.9}) {
    for (const bool power_goes : {false, true}) {
      int missed = 0;
      double sum = 0, truth_sum = 0, plain = 0;
      for (int time = 0; time < kTimes; ++time) {
        std::vector<std::vector<bool>> truths(1, std::vector<bool>(72));
        int all = 0;
        for (auto&& one : truths[0]) {
          one = uniform(bits) < rate;
          all += one ? 1 : 0;
        }
        const auto ended = run_in_time(width(15), truths, kWorkers,
                                       power_goes ? 6 * uniform(bits) : 1e9);
        const stats::Drawn& drawn = ended.tasks[0];
        const auto [at, is_new] =
            known.try_emplace({drawn.successes, drawn.failures, drawn.total});
        if (is_new) at->second = stats::rate_of_drawn(drawn);
        const double truth = all / 72.0;
        missed += at->second.low > truth + 1e-12 || at->second.high < truth - 1e-12 ? 1 : 0;
        if (drawn.drawn() == 0) continue;
        sum += static_cast<double>(drawn.successes) / static_cast<double>(drawn.drawn());
        truth_sum += truth;
        plain += ended.plain / ended.rows;
      }
      MESSAGE("8 worlds, rate " << rate << std::string(power_goes ? ", killed" : ", stopped")
                                << ": missed " << 100.0 * missed / kTimes
                                << " %, counted rate off by " << 100 * (sum - truth_sum) / kTimes
                                << " points on average, that of all rows by "
                                << 100 * (plain - truth_sum) / kTimes);
      CHECK(missed <= 0.05 * kTimes);
      // Whatever is looked at at some time of the clock has more of what is done fast.
      if (power_goes) {
        CHECK(std::abs(sum - truth_sum) < std::abs(plain - truth_sum));
      } else {
        CHECK(std::abs(sum - truth_sum) / kTimes < 0.015);
      }
    }
  }
}

TEST_CASE("several tasks with many worlds: the rate of all is missed at most one time in twenty") {
  constexpr int kTimes = 400, kTasks = 6, kStarts = 24, kWorkers = 8;
  std::mt19937 bits(23);
  int missed_each = 0, missed_all = 0;
  for (int time = 0; time < kTimes; ++time) {
    std::vector<std::vector<bool>> truths(kTasks, std::vector<bool>(kStarts));
    double truth = 0;
    for (auto& task : truths) {
      const double rate = uniform(bits);
      for (auto&& one : task) {
        one = uniform(bits) < rate;
        truth += one ? 1.0 / (kTasks * kStarts) : 0;
      }
    }
    const auto misses = [&](const stats::Interval& interval) {
      return interval.low > truth + 1e-12 || interval.high < truth - 1e-12 ? 1 : 0;
    };
    // The least sure task next, as far as is known while others are under way.
    const auto each = run_in_time(width(30), truths, kWorkers, 1e9);
    missed_each += misses(stats::rate_of_lists(each.tasks, stats::Drawing::kInTurn));
    stats::Drawn together;
    for (const stats::Drawn& one :
         run_in_time(width(15, Rule::Kind::kAllTasks), truths, kWorkers, 1e9).tasks) {
      together.total += one.total;
      together.successes += one.successes;
      together.failures += one.failures;
    }
    missed_all += misses(stats::rate_of_drawn(together));
  }
  MESSAGE("6 tasks, 8 worlds, rates from 0 to 1: the rate of all missed " << 100.0 * missed_each / kTimes
          << " % in turn, " << 100.0 * missed_all / kTimes << " % in one order");
  CHECK(missed_each <= 0.05 * kTimes);
  CHECK(missed_all <= 0.05 * kTimes);
}

TEST_CASE("a decision between equal policies is false at most one time in twenty, and real ones are made") {
  constexpr int kTimes = 2000, kStarts = 288;
  std::mt19937 bits(5);
  struct Setting {
    double ours, theirs;
    int seeds;
  };
  for (const Setting& of : {Setting{0.5, 0.5, 1}, {0.9, 0.9, 1}, {0.5, 0.5, 3}, {0.6, 0.5, 1},
                            {0.7, 0.5, 1}, {0.5, 0.8, 1}, {0.5, 0.8, 3}}) {
    int better = 0, worse = 0;
    double run = 0;
    for (int time = 0; time < kTimes; ++time) {
      std::vector<Planned> order;
      for (std::uint32_t start = 0; start < kStarts; ++start) {
        for (int seed = 0; seed < of.seeds; ++seed)
          order.push_back({0, start, Outcome::kAbsent, uniform(bits) < of.theirs});
      }
      Chooser chooser(decided(), order);
      run_all(chooser, [&](const Planned&) {
        run += 1.0 / kTimes / of.seeds;
        return as(uniform(bits) < of.ours);
      });
      const Decision& decision = chooser.decision();
      better += decision.verdict() == Decision::Verdict::kBetter ? 1 : 0;
      worse += decision.verdict() == Decision::Verdict::kWorse ? 1 : 0;
    }
    MESSAGE("success " << of.ours << " against " << of.theirs << ", " << of.seeds << " seeds: better "
                       << 100.0 * better / kTimes << " %, worse " << 100.0 * worse / kTimes
                       << " %, after " << run << " of " << kStarts << " starts on average");
    const int right = of.ours > of.theirs ? better : of.ours < of.theirs ? worse : 0;
    CHECK(better + worse - right <= 0.05 * kTimes);
    if (std::abs(of.ours - of.theirs) > 0.15) CHECK(right >= 0.9 * kTimes);
  }
}

TEST_CASE("the evidence of a decision is that of a sequential comparison") {
  std::mt19937 bits(2);
  Decision decision;
  stats::SequentialComparison comparison;
  for (int start = 0; start < 200; ++start) {
    const bool ours = uniform(bits) < 0.6, theirs = uniform(bits) < 0.5;
    decision.add(std::vector{std::pair(as(ours), theirs)});
    comparison.add((ours ? 1 : 0) - (theirs ? 1 : 0));
  }
  CHECK(decision.ever().p == doctest::Approx(comparison.p_value()).epsilon(1e-9));
  CHECK(decision.won() == comparison.a_wins());
}

TEST_CASE("what is invalid counts against whatever is to be decided") {
  const auto verdict = [](int wins, int unknown) {
    Decision decision;
    for (int i = 0; i < wins; ++i)
      decision.add(std::vector{std::pair(Outcome::kSuccess, false)});
    for (int i = 0; i < unknown; ++i)
      decision.add(std::vector{std::pair(Outcome::kUnknown, true)});
    for (int i = 0; i < 3; ++i) decision.add(std::vector{std::pair(Outcome::kSuccess, false)});
    return decision.verdict();
  };
  CHECK(verdict(6, 0) == Decision::Verdict::kBetter);
  CHECK(verdict(3, 3) == Decision::Verdict::kOpen);
}

}  // namespace probe::adaptive
