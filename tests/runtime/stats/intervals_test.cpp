#include "runtime/stats/intervals.h"

#include <doctest/doctest.h>

#include <algorithm>
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

TEST_CASE("no episode says nothing about a rate") {
  check_interval(wilson({0, 0}), 0, 1);
  CHECK(std::isnan(Count{0, 0}.rate()));
}

TEST_CASE("an interval of all or none ends exactly at 1 or 0") {
  CHECK(wilson({0, 3600}).low == 0);
  CHECK(wilson({3600, 3600}).high == 1);
  CHECK(wilson({0, 3600}).high > 0);
}

// Exact coverage at n = 24: the binomial probability of all counts whose interval holds the truth.
TEST_CASE("Wilson's interval covers 95 % of the rates there are, and none much less") {
  double total = 0, least = 1;
  int rates = 0;
  for (double p = 0.02; p < 1; p += 0.02) {
    double covered = 0;
    double chance = std::pow(1 - p, 24);
    for (int k = 0; k <= 24; ++k) {
      const Interval i = wilson({k, 24});
      if (i.low <= p && p <= i.high) covered += chance;
      chance *= (24.0 - k) / (k + 1) * p / (1 - p);
    }
    total += covered;
    least = std::min(least, covered);
    ++rates;
  }
  CHECK(total / rates >= 0.95);
  CHECK(least >= 0.9);
}

}  // namespace probe::stats
