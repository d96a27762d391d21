#include "runtime/stats/here_and_anew.h"

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

namespace probe::stats {
namespace {

// Every task once in every place; `pairs` of each start.
std::vector<PlacedPairs> crossed(std::uint32_t tasks, std::uint32_t places,
                                 const PairTable& pairs) {
  std::vector<PlacedPairs> rows;
  for (std::uint32_t task = 0; task < tasks; ++task) {
    for (std::uint32_t place = 0; place < places; ++place)
      rows.push_back({pairs, task, task * places + place, place});
  }
  return rows;
}

}  // namespace

TEST_CASE("24 tasks in 6 places, all won: certain on these starts, not for starts never tried") {
  const HereAndAnew won = compare_here_and_anew(crossed(24, 6, {.only_a = 1}));
  CHECK(won.difference == 1);
  CHECK(std::log2(won.here.p) == doctest::Approx(-143));
  CHECK(won.anew.p == doctest::Approx(2.0 / 64));
  CHECK(won.here.nets == std::vector<std::int64_t>(144, 1));
  CHECK(won.anew.nets == std::vector<std::int64_t>(6, 24));
  CHECK(won.here.interval.low > 0.95);
  CHECK(won.anew.interval.low > 0);
  CHECK(won.anew.interval.low < 0.6);
}

TEST_CASE("seeds that repeat a start are one finding for both questions") {
  const HereAndAnew won = compare_here_and_anew(crossed(2, 3, {.only_a = 5}));
  CHECK(won.here.p == doctest::Approx(2.0 / 64));
  CHECK(won.anew.p == doctest::Approx(2.0 / 8));
}

TEST_CASE("one task's starts are places, so both questions have one answer") {
  std::vector<PlacedPairs> rows;
  for (std::uint32_t i = 0; i < 24; ++i) {
    rows.push_back({i < 9    ? PairTable{.only_a = 1, .neither = 1}
                    : i < 12 ? PairTable{.only_b = 2}
                             : PairTable{.both = 2},
                    0, i, i});
  }
  const HereAndAnew answers = compare_here_and_anew(rows);
  CHECK(answers.here.p == answers.anew.p);
  CHECK(answers.here.interval.low == answers.anew.interval.low);
  CHECK(answers.here.interval.high == answers.anew.interval.high);
}

// Where A wins in one half of the places and loses in the other, every start is decided, and yet
// nothing is known of the next place.
TEST_CASE("places that favour one side each say nothing of starts never tried") {
  std::vector<PlacedPairs> rows;
  for (std::uint32_t task = 0; task < 20; ++task) {
    for (std::uint32_t place = 0; place < 7; ++place) {
      rows.push_back({place < 4 ? PairTable{.only_a = 1} : PairTable{.only_b = 1}, task,
                      task * 7 + place, place});
    }
  }
  const HereAndAnew answers = compare_here_and_anew(rows);
  CHECK(answers.here.p < 0.2);
  CHECK(answers.anew.p == 1);
  CHECK(answers.anew.interval.high - answers.anew.interval.low >
        2 * (answers.here.interval.high - answers.here.interval.low));
}

TEST_CASE("no pairs answer nothing") {
  const HereAndAnew answers = compare_here_and_anew({});
  CHECK(answers.here.p == 1);
  CHECK(answers.anew.interval.low == -1);
  CHECK(answers.anew.interval.high == 1);
}

}  // namespace probe::stats
