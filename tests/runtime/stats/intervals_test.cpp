#include "runtime/stats/intervals.h"

#include <doctest/doctest.h>

#include <cmath>

namespace probe::stats {
namespace {

void check_interval(Interval got, double low, double high) {
  CHECK(got.low == doctest::Approx(low).epsilon(1e-7));
  CHECK(got.high == doctest::Approx(high).epsilon(1e-7));
}

}  // namespace

// R 4.2.2: prop.test(7, 24, correct = FALSE).
TEST_CASE("Wilson's interval equals R's prop.test without continuity correction") {
  check_interval(wilson({7, 24}), 0.149146482, 0.491676937);
}

// R 4.2.2: binom.test(7, 24) and binom.test(0, 24).
TEST_CASE("Clopper and Pearson's interval equals R's binom.test") {
  check_interval(clopper_pearson({7, 24}), 0.126152089, 0.510947814);
  check_interval(clopper_pearson({0, 24}), 0, 0.142473598);
  check_interval(clopper_pearson({24, 24}), 1 - 0.142473598, 1);
}

// R 4.2.2: qbeta(c(.025, .975), 7.5, 17.5) and qbeta(.975, 0.5, 24.5).
TEST_CASE("Jeffreys' interval equals the quantiles of its beta distribution") {
  check_interval(jeffreys({7, 24}), 0.141024590, 0.489236434);
  check_interval(jeffreys({0, 24}), 0, 0.0983876044);
}

TEST_CASE("no episode says nothing about a rate") {
  check_interval(wilson({0, 0}), 0, 1);
  check_interval(clopper_pearson({0, 0}), 0, 1);
  check_interval(jeffreys({0, 0}), 0, 1);
  CHECK(std::isnan(Count{0, 0}.rate()));
}

TEST_CASE("an interval of all or none ends exactly at 1 or 0") {
  CHECK(wilson({0, 3600}).low == 0);
  CHECK(wilson({3600, 3600}).high == 1);
  CHECK(wilson({0, 3600}).high > 0);
}

// Exact coverage at n = 24: the binomial probability of all counts whose interval holds the truth.
TEST_CASE("Clopper and Pearson's interval covers at least 95 % of every rate") {
  for (double p = 0.02; p < 1; p += 0.02) {
    double covered = 0;
    double chance = std::pow(1 - p, 24);
    for (int k = 0; k <= 24; ++k) {
      const Interval i = clopper_pearson({k, 24});
      if (i.low <= p && p <= i.high) covered += chance;
      chance *= (24.0 - k) / (k + 1) * p / (1 - p);
    }
    CAPTURE(p);
    CHECK(covered >= 0.95);
  }
}

}  // namespace probe::stats
