#include "runtime/stats/sequential.h"

#include <doctest/doctest.h>

#include <cmath>
#include <random>

namespace probe::stats {

// One win: 2 B(3/2, 1/2) / B(1/2, 1/2) = 2 * 1/2 = 1; two wins: 4 * (3/8) = 3/2; a win and a loss:
// 4 * 1/8.
TEST_CASE("the evidence of a few starts equals its closed form") {
  SequentialComparison c;
  CHECK(c.log_evidence() == doctest::Approx(0));
  c.add(1);
  CHECK(c.log_evidence() == doctest::Approx(0));
  c.add(3);
  CHECK(std::exp(c.log_evidence()) == doctest::Approx(1.5));
  SequentialComparison even;
  even.add(1);
  even.add(-1);
  CHECK(std::exp(even.log_evidence()) == doctest::Approx(0.5));
  CHECK(even.p_value() == 1);
}

TEST_CASE("ties are no news") {
  SequentialComparison c;
  for (int i = 0; i < 100; ++i) c.add(0);
  CHECK(c.a_wins() + c.b_wins() == 0);
  CHECK(c.p_value() == 1);
}

TEST_CASE("looking after every start errs less often than promised") {
  std::mt19937 bits(314);
  int stopped = 0;
  const int runs = 4000;
  for (int run = 0; run < runs; ++run) {
    SequentialComparison c;
    for (int i = 0; i < 400 && c.p_value() > 0.05; ++i) c.add((bits() & 1U) != 0 ? 1 : -1);
    stopped += c.p_value() <= 0.05 ? 1 : 0;
  }
  MESSAGE("stopped in error: " << stopped << " of " << runs << ", allowed 5 %");
  CHECK(stopped <= runs / 20);
}

TEST_CASE("a real difference is found early") {
  std::mt19937 bits(7);
  SequentialComparison c;
  int starts = 0;
  while (c.p_value() > 0.05 && starts < 1200) {
    c.add(bits() % 10 < 8 ? 1 : -1);
    ++starts;
  }
  CHECK(starts < 100);
}

}  // namespace probe::stats
