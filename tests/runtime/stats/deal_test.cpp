#include "runtime/stats/deal.h"

#include <doctest/doctest.h>

#include <cmath>

namespace probe::stats {
namespace {

// Both ways from the mean to the largest sum.
void check_agree(const Deck& deck, std::int64_t hand, std::int64_t from, std::int64_t to,
                 std::int64_t step) {
  for (std::int64_t least = from; least <= to; least += step) {
    const double counted = deal_by_counting(deck, hand, least);
    const double inverted = deal_by_inversion(deck, hand, least);
    CAPTURE(least);
    CAPTURE(counted);
    CAPTURE(inverted);
    CHECK(std::abs(inverted - counted) <= 1e-9 * counted);
  }
}

}  // namespace

// Of three cards 0, 1 and 2, two add up to 1, 2 or 3.
TEST_CASE("the hands of a small deck are counted") {
  const Deck deck = {{0, 1}, {1, 1}, {2, 1}};
  CHECK(deal_at_least(deck, 2, 2) == doctest::Approx(2.0 / 3));
  CHECK(deal_at_least(deck, 2, 3) == doctest::Approx(1.0 / 3));
  CHECK(deal_at_least(deck, 2, 4) == 0);
}

TEST_CASE("counting and inversion of a deal agree from the mean to the end of the tail") {
  check_agree({{0, 30}, {1, 18}, {2, 19}, {3, 53}}, 60, 105, 178, 9);  // mean 107.5
  check_agree({{0, 200}, {1, 16}, {2, 9}, {3, 40}}, 24, 14, 72, 7);
  check_agree({{0, 5}, {1, 3}}, 4, 2, 3, 1);
}

// Nearly all cards are even, so the sum's distribution is nearly one of even numbers.
TEST_CASE("a few cards between the steps of the others are dealt with") {
  check_agree({{0, 60}, {2, 40}, {3, 1}, {4, 50}, {6, 90}}, 50, 182, 297, 23);
}

}  // namespace probe::stats
