#include "runtime/stats/betting.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace probe::stats {
namespace {

using Outcomes = std::vector<BoundedOutcome>;

// The mixture, written out.
double plainly(const Outcomes& outcomes, double least) {
  double sum = 0;
  for (int k = 0; k < 16; ++k) {
    double capital = 1;
    for (const BoundedOutcome& o : outcomes)
      capital *= 1 + 0.495 * std::pow(2, -k / 2.0) * o.weight * (least - o.value);
    sum += capital / 16;
  }
  return sum;
}

// Net successes of one start with `seeds` seeds: new with chance p, old with chance q, each start's
// own.
BoundedOutcome start_of(std::mt19937& bits, double p, double q, int seeds) {
  std::uniform_real_distribution<double> share(0, 1);
  int net = 0;
  for (int s = 0; s < seeds; ++s) net += (share(bits) < p ? 1 : 0) - (share(bits) < q ? 1 : 0);
  return {static_cast<double>(net) / seeds, 1};
}

}  // namespace

TEST_CASE("the evidence is the capital of a mixture of constant bets, in whatever order") {
  Outcomes outcomes = {{-1, 1}, {0, 1}, {1, 1}, {-1, 0.5}, {-1.0 / 3, 1}, {0, 1}, {-1, 1}};
  for (const double least : {-1.0, -0.3, -0.02, 0.0, 0.5, 1.0}) {
    CHECK(std::exp(log_evidence_below(outcomes, least)) ==
          doctest::Approx(plainly(outcomes, least)).epsilon(1e-12));
    Outcomes other = outcomes;
    std::reverse(other.begin(), other.end());
    CHECK(log_evidence_below(other, least) == log_evidence_below(outcomes, least));
  }
  CHECK(log_evidence_below({}, 0) == 0);
}

TEST_CASE("the more is claimed, the more speaks against it, and the bounds are where that turns") {
  std::mt19937 bits(1);
  Outcomes outcomes;
  for (int i = 0; i < 300; ++i) outcomes.push_back(start_of(bits, 0.5, 0.7, 3));
  double before = -1e9;
  for (double least = -1; least <= 1; least += 0.05) {
    const double now = log_evidence_below(outcomes, least);
    CHECK(now > before);
    before = now;
  }
  const Interval bounds = bounds_by_betting(outcomes);
  CHECK(bounds.low < -0.2);
  CHECK(bounds.high > -0.2);
  CHECK(bounds.high < 0);
  CHECK(log_evidence_below(outcomes, bounds.high) == doctest::Approx(std::log(40)).epsilon(1e-9));
  const Interval nothing = bounds_by_betting({});
  CHECK(nothing.low == -1);
  CHECK(nothing.high == 1);
}

// 2,000 made-up comparisons a setting, looked at after every start: starts of their own difficulty,
// a mean drop exactly as large as is allowed.
TEST_CASE("a drop that is allowed is called a regression less often than stated, at any time") {
  struct Setting {
    double allow;
    int seeds;
    double spread;  // of the drop over starts, half of them each way
  };
  for (const Setting s : {Setting{0, 1, 0}, Setting{0.02, 1, 0.3}, Setting{0.05, 3, 0.4}}) {
    std::mt19937 bits(11);
    int stopped = 0, missed = 0;
    const int runs = 2000, starts = 120;
    for (int run = 0; run < runs; ++run) {
      Outcomes outcomes;
      bool is_stopped = false;
      for (int i = 0; i < starts; ++i) {
        const double drop = s.allow + ((bits() & 1U) != 0 ? s.spread : -s.spread);
        outcomes.push_back(start_of(bits, 0.5 - drop / 2, 0.5 + drop / 2, s.seeds));
        if (!is_stopped && i % 5 == 4)
          is_stopped = log_evidence_below(outcomes, -s.allow) >= std::log(20);
      }
      stopped += is_stopped ? 1 : 0;
      const Interval bounds = bounds_by_betting(outcomes);
      missed += bounds.low <= -s.allow && -s.allow <= bounds.high ? 0 : 1;
    }
    MESSAGE("allowed " << s.allow << ", " << s.seeds << " seeds: stopped in error " << stopped
                       << ", bounds that miss " << missed << " of " << runs << ", stated 5 %");
    CHECK(stopped <= runs / 20);
    CHECK(missed <= runs / 20);
  }
}

// Starts of unlike expectations in an order that is not drawn: the worst first. At the end, which
// is fixed beforehand, the promise holds all the same.
TEST_CASE("the promise holds for starts of unlike expectations when all have been run") {
  std::mt19937 bits(5);
  int refused = 0;
  const int runs = 2000;
  for (int run = 0; run < runs; ++run) {
    Outcomes outcomes;
    for (int i = 0; i < 50; ++i) outcomes.push_back(start_of(bits, 0.2, 0.8, 1));
    for (int i = 0; i < 50; ++i) outcomes.push_back(start_of(bits, 0.8, 0.2, 1));
    refused += log_evidence_below(outcomes, 0) >= std::log(20) ? 1 : 0;
  }
  MESSAGE("refused in error " << refused << " of " << runs << ", stated 5 %");
  CHECK(refused <= runs / 20);
}

}  // namespace probe::stats
