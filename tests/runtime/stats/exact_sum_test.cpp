#include "runtime/stats/exact_sum.h"

#include <doctest/doctest.h>

#include <array>
#include <chrono>
#include <cmath>

namespace probe::stats {
namespace {

// `times` numbers that are each v or -v.
void add_signs(ExactSum& sum, std::int64_t v, int times) {
  for (int i = 0; i < times; ++i) sum.add(std::array{v, -v});
}

void check_same(double a, double b) {
  CAPTURE(a);
  CAPTURE(b);
  CHECK(std::abs(a - b) <= 1e-9 * b);
}

}  // namespace

// Sums of +-3 +-2 +-1: 6 and -6 have one choice each of 8, 4 and -4 as well.
TEST_CASE("the choices of a few numbers are counted") {
  ExactSum sum;
  for (const std::int64_t v : {3, 2, 1}) add_signs(sum, v, 1);
  CHECK(sum.tail(6) == doctest::Approx(2.0 / 8));
  CHECK(sum.tail(-4) == doctest::Approx(4.0 / 8));
  CHECK(sum.tail(0) == 1);
  CHECK(sum.tail(7) == 0);
  CHECK(ExactSum().tail(0) == 1);
}

TEST_CASE("counting and inversion agree from the middle to the end of the tail") {
  ExactSum mixed;
  add_signs(mixed, 1, 40);
  add_signs(mixed, 2, 17);
  add_signs(mixed, 3, 25);
  for (int i = 0; i < 9; ++i) mixed.add(std::array<std::int64_t, 4>{-3, 1, 1, 1});
  for (const std::int64_t least : {-140, -60, -1, 0, 1, 10, 40, 80, 120, 150, 157, 158}) {
    CAPTURE(least);
    check_same(mixed.at_least_by_inversion(least), mixed.at_least_by_counting(least));
  }
  ExactSum few;
  add_signs(few, 3, 3);
  for (const std::int64_t least : {-9, -3, 0, 3, 4, 9})
    check_same(few.at_least_by_inversion(least), few.at_least_by_counting(least));
  CHECK(few.at_least_by_inversion(10) == 0);
}

TEST_CASE("the end of a long sum is one choice of very many") {
  ExactSum sum;
  add_signs(sum, 1, 900);
  check_same(sum.tail(900), std::ldexp(1, -899));
  add_signs(sum, 2, 100'000);
  CHECK(sum.tail(200'900) == 0);  // 2^-100,899
}

// P(|X - n / 2| >= d) of a binomial, from its largest term by ratios.
TEST_CASE("tens of thousands of signs are the binomial's tail") {
  constexpr int kSigns = 92'400;
  double term = 1, all = 0, tail = 0;
  for (int k = kSigns / 2; k <= kSigns; ++k) {
    all += (k == kSigns / 2 ? 1 : 2) * term;
    if (2 * k - kSigns >= 1500) tail += 2 * term;
    term *= static_cast<double>(kSigns - k) / (k + 1);
  }
  ExactSum sum;
  add_signs(sum, 1, kSigns);
  check_same(sum.tail(1500), tail / all);
}

}  // namespace probe::stats
