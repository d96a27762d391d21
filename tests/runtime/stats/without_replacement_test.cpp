// Evidence and intervals of finite lists: written out in small cases, and as promised in made-up
// ones.
#include "runtime/stats/without_replacement.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <random>
#include <vector>

namespace probe::stats {
namespace {

// One outcome after the other: the bettor's share of it over its chance in such a list.
double plainly(std::int64_t total, std::int64_t all, const std::vector<bool>& outcomes) {
  double capital = 1, successes = 0, failures = 0;
  for (const bool outcome : outcomes) {
    const double left = static_cast<double>(total) - successes - failures;
    const double chance = (static_cast<double>(all) - successes) / left;
    const double bet = (successes + 0.5) / (successes + failures + 1);
    capital *= outcome ? bet / chance : (1 - bet) / (1 - chance);
    ++(outcome ? successes : failures);
  }
  return capital;
}

// A list of `total` with `all` successes, shuffled.
std::vector<bool> shuffled(std::mt19937& bits, int total, int all) {
  std::vector<bool> list(static_cast<std::size_t>(total));
  std::fill(list.begin(), list.begin() + all, true);
  for (std::size_t i = list.size(); i-- > 1;) {
    const std::size_t j = bits() % (i + 1);
    const bool kept = list[i];
    list[i] = list[j];
    list[j] = kept;
  }
  return list;
}

// Each interval is asked for many times.
class Intervals {
 public:
  Interval of(const Drawn& list) {
    const auto [at, is_new] =
        known_.try_emplace({list.total, list.successes, list.failures, list.unknown});
    if (is_new) at->second = rate_of_drawn(list);
    return at->second;
  }

 private:
  std::map<std::array<std::int64_t, 4>, Interval> known_;
};

bool covers(const Interval& interval, double rate) {
  return interval.low <= rate + 1e-12 && rate <= interval.high + 1e-12;
}

}  // namespace

TEST_CASE("the evidence against a number of successes is the capital of a bettor, bet by bet") {
  const std::vector<bool> outcomes = {true, false, true, true, false};
  for (std::int64_t all = 3; all <= 10; ++all)
    CHECK(std::exp(log_evidence_against(12, all, 3, 2)) ==
          doctest::Approx(plainly(12, all, outcomes)).epsilon(1e-10));
  CHECK(std::isinf(log_evidence_against(12, 2, 3, 2)));
  CHECK(std::isinf(log_evidence_against(12, 11, 3, 2)));
  CHECK(log_evidence_against(12, 7, 0, 0) == doctest::Approx(0));
}

TEST_CASE("an interval begins with everything and ends with the rate itself") {
  CHECK(rate_of_drawn({24, 0, 0, 0}).low == 0);
  CHECK(rate_of_drawn({24, 0, 0, 0}).high == 1);
  CHECK(rate_of_drawn({0, 0, 0, 0}).high == 1);
  const Interval all = rate_of_drawn({24, 7, 17, 0});
  CHECK(all.low == doctest::Approx(7.0 / 24));
  CHECK(all.high == doctest::Approx(7.0 / 24));
  // What nobody knows may have been either.
  const Interval open = rate_of_drawn({24, 7, 15, 2});
  CHECK(open.low == doctest::Approx(7.0 / 24));
  CHECK(open.high == doctest::Approx(9.0 / 24));
  const Interval with = rate_of_drawn({72, 10, 10, 3});
  CHECK(with.low == doctest::Approx(rate_of_drawn({72, 10, 13, 0}).low));
  CHECK(with.high == doctest::Approx(rate_of_drawn({72, 13, 10, 0}).high));
}

TEST_CASE("intervals of successes and of failures mirror one another") {
  for (int n = 0; n <= 24; n += 3) {
    for (int k = 0; k <= n; k += 2) {
      const Interval a = rate_of_drawn({30, k, n - k, 0}), b = rate_of_drawn({30, n - k, k, 0});
      CHECK(a.low == doctest::Approx(1 - b.high));
      CHECK(a.high == doctest::Approx(1 - b.low));
      if (n > 0) CHECK(a.low * n <= k + 1e-9);
      if (n > 0) CHECK(a.high * n >= k - 1e-9);
    }
  }
}

TEST_CASE("stopped where the interval is narrow, it misses the rate at most one time in twenty") {
  Intervals intervals;
  std::mt19937 bits(20241128);
  for (const int total : {24, 72}) {
    for (const double rate : {0.02, 0.1, 0.5, 0.9, 1.0}) {
      constexpr int kTimes = 2000;
      int missed = 0, ever = 0;
      std::int64_t drawn = 0;
      for (int time = 0; time < kTimes; ++time) {
        // Each episode ends by its own chance; the list is what came of it.
        int all = 0;
        for (int i = 0; i < total; ++i) all += static_cast<double>(bits()) < rate * 4294967296.0 ? 1 : 0;
        const auto list = shuffled(bits, total, all);
        const double truth = static_cast<double>(all) / total;
        Drawn so_far{total, 0, 0, 0};
        bool has_stopped = false, has_missed = false;
        for (const bool outcome : list) {
          ++(outcome ? so_far.successes : so_far.failures);
          const Interval now = intervals.of(so_far);
          has_missed = has_missed || !covers(now, truth);
          if (has_stopped || now.high - now.low > 0.1 + 1e-9) continue;
          has_stopped = true;
          drawn += so_far.drawn();
          missed += covers(now, truth) ? 0 : 1;
        }
        ever += has_missed ? 1 : 0;
        REQUIRE(has_stopped);  // at the latest when all is drawn
      }
      MESSAGE("rate " << rate << " of " << total << " episodes: missed " << 100.0 * missed / kTimes
                      << " % when stopped, " << 100.0 * ever / kTimes << " % ever, after "
                      << static_cast<double>(drawn) / kTimes << " on average");
      CHECK(missed <= 0.05 * kTimes);
      CHECK(ever <= 0.05 * kTimes);
    }
  }
}

TEST_CASE("several lists: in turn or anyhow, their common rate is missed at most one time in twenty") {
  std::mt19937 bits(7);
  constexpr int kTimes = 400, kLists = 12, kTotal = 24;
  int missed_in_turn = 0, missed_anyhow = 0;
  double width_in_turn = 0, width_anyhow = 0, widest = 0;
  Intervals intervals;
  for (int time = 0; time < kTimes; ++time) {
    std::vector<std::vector<bool>> lists;
    std::vector<Drawn> drawn;
    double truth = 0;
    for (int i = 0; i < kLists; ++i) {
      const int all = static_cast<int>(bits() % (kTotal + 1));
      lists.push_back(shuffled(bits, kTotal, all));
      drawn.push_back({kTotal, 0, 0, 0});
      truth += static_cast<double>(all) / (kTotal * kLists);
    }
    // The widest next, until all are narrow: what `run --until "width 30%"` does.
    for (;;) {
      std::size_t next = 0;
      double width = 0;
      for (std::size_t i = 0; i < drawn.size(); ++i) {
        const Interval one = intervals.of(drawn[i]);
        if (one.high - one.low <= width) continue;
        width = one.high - one.low;
        next = i;
      }
      if (width <= 0.3) {
        widest += width / kTimes;
        break;
      }
      const bool outcome = lists[next][static_cast<std::size_t>(drawn[next].drawn())];
      ++(outcome ? drawn[next].successes : drawn[next].failures);
    }
    const Interval in_turn = rate_of_lists(drawn, Drawing::kInTurn);
    const Interval anyhow = rate_of_lists(drawn, Drawing::kAnyhow);
    missed_in_turn += covers(in_turn, truth) ? 0 : 1;
    missed_anyhow += covers(anyhow, truth) ? 0 : 1;
    width_in_turn += (in_turn.high - in_turn.low) / kTimes;
    width_anyhow += (anyhow.high - anyhow.low) / kTimes;
  }
  MESSAGE("12 lists of 24, the widest at most " << 100 * widest << " points: together "
          << 100 * width_in_turn << " points in turn (missed " << 100.0 * missed_in_turn / kTimes
          << " %), " << 100 * width_anyhow << " anyhow (" << 100.0 * missed_anyhow / kTimes << " %)");
  CHECK(missed_in_turn <= 0.05 * kTimes);
  CHECK(missed_anyhow <= 0.05 * kTimes);
  CHECK(width_in_turn < width_anyhow);
  // One list alone, and lists that are known.
  const std::vector<Drawn> one = {{24, 5, 3, 1}};
  CHECK(rate_of_lists(one, Drawing::kInTurn).low == doctest::Approx(rate_of_drawn(one[0]).low));
  CHECK(rate_of_lists(one, Drawing::kInTurn).high == doctest::Approx(rate_of_drawn(one[0]).high));
  CHECK(rate_of_lists(one, Drawing::kAnyhow).high == doctest::Approx(rate_of_drawn(one[0]).high));
  const std::vector<Drawn> known = {{24, 12, 12, 0}, {72, 72, 0, 0}};
  for (const Drawing drawing : {Drawing::kInTurn, Drawing::kAnyhow}) {
    CHECK(rate_of_lists(known, drawing).low == doctest::Approx(84.0 / 96));
    CHECK(rate_of_lists(known, drawing).high == doctest::Approx(84.0 / 96));
  }
}

TEST_CASE("what nobody knows of several lists makes the interval as wide as any way to fill it in") {
  const auto check = [](const std::vector<Drawn>& lists) {
    const Interval open = rate_of_lists(lists, Drawing::kInTurn);
    std::vector<Drawn> filled = lists;
    const std::function<void(std::size_t)> fill = [&](std::size_t i) {
      if (i == lists.size()) {
        const Interval one = rate_of_lists(filled, Drawing::kInTurn);
        CHECK(open.low <= one.low + 1e-12);
        CHECK(open.high >= one.high - 1e-12);
        return;
      }
      for (std::int64_t k = 0; k <= lists[i].unknown; ++k) {
        filled[i] = {lists[i].total, lists[i].successes + k,
                     lists[i].failures + lists[i].unknown - k, 0};
        fill(i + 1);
      }
    };
    fill(0);
  };
  // Filled with successes alone, the second and the third leave the first less than with one failure.
  check({{300, 0, 6, 0}, {12, 0, 1, 2}, {12, 9, 0, 1}});
  std::mt19937 bits(19);
  for (int time = 0; time < 300; ++time) {
    std::vector<Drawn> lists;
    for (auto left = 1 + bits() % 3; left > 0; --left) {
      Drawn list{static_cast<std::int64_t>(6 + bits() % 60), 0, 0, static_cast<std::int64_t>(bits() % 4)};
      const auto known = static_cast<std::int64_t>(bits() % 11) % (list.total - list.unknown + 1);
      list.successes = bits() % 2 == 0 ? static_cast<std::int64_t>(bits()) % (known + 1)
                                       : known * static_cast<std::int64_t>(bits() % 2);
      list.failures = known - list.successes;
      lists.push_back(list);
    }
    check(lists);
  }
}

}  // namespace probe::stats
