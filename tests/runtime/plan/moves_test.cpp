// Ways that objects take by themselves.
#include "runtime/plan/moves.h"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

namespace probe::plan {
namespace {

std::vector<MoveRecord> way(Way kind, std::initializer_list<std::array<double, 2>> places,
                            double speed) {
  std::vector<MoveRecord> legs;
  for (const auto& to : places) legs.push_back({0, static_cast<std::uint32_t>(kind), to, speed});
  return legs;
}

void check_at(const std::vector<MoveRecord>& legs, double seconds, double x, double y) {
  CAPTURE(seconds);
  const auto at = offset_at(legs, seconds);
  CHECK(at[0] == doctest::Approx(x).epsilon(1e-12));
  CHECK(at[1] == doctest::Approx(y).epsilon(1e-12));
}

TEST_CASE("there and back, over and over, corner by corner") {
  const auto legs = way(Way::kBack, {{0.3, 0}, {0.3, 0.4}}, 0.1);  // 0.7 m
  check_at(legs, 0, 0, 0);
  check_at(legs, 1, 0.1, 0);
  check_at(legs, 3, 0.3, 0);
  check_at(legs, 5, 0.3, 0.2);
  check_at(legs, 7, 0.3, 0.4);
  check_at(legs, 8, 0.3, 0.3);
  check_at(legs, 13, 0.1, 0);
  check_at(legs, 15, 0.1, 0);
  CHECK(std::isinf(moves_until(legs)));
}

TEST_CASE("a loop goes from its last place straight to where it began") {
  const auto legs = way(Way::kLoop, {{0.3, 0}, {0.3, 0.4}}, 0.1);  // and 0.5 m back
  check_at(legs, 7, 0.3, 0.4);
  check_at(legs, 9.5, 0.15, 0.2);
  check_at(legs, 12, 0, 0);
  check_at(legs, 13, 0.1, 0);
}

TEST_CASE("once there it stays") {
  const auto legs = way(Way::kOnce, {{0.3, 0}}, 0.1);
  check_at(legs, 2, 0.2, 0);
  check_at(legs, 100, 0.3, 0);
  CHECK(moves_until(legs) == doctest::Approx(3));
}

TEST_CASE("a circle begins where the object lies and is walked counterclockwise at its speed") {
  const auto legs = way(Way::kRound, {{0.1, 0}}, 0.1);
  const double round = 2 * std::numbers::pi;  // s
  check_at(legs, 0, 0, 0);
  check_at(legs, round / 4, 0.1, -0.1);
  check_at(legs, round / 2, 0.2, 0);
  check_at(legs, 3 * round / 4, 0.1, 0.1);
  for (double t = 0; t < 2 * round; t += 0.3) {
    const auto at = offset_at(legs, t);
    CHECK(std::hypot(at[0] - 0.1, at[1]) == doctest::Approx(0.1).epsilon(1e-12));
  }
}

TEST_CASE("words of a way are those of its text") {
  CHECK(move_text(way(Way::kBack, {{0.05, 0}}, 0.05)) == "along (5cm, 0cm) at 5cm/s");
  CHECK(move_text(way(Way::kOnce, {{0.05, 0}, {0.05, -0.1}}, 0.05)) ==
        "along (5cm, 0cm), (5cm, -10cm) at 5cm/s once");
  CHECK(move_text(way(Way::kRound, {{0.04, 0}}, 0.02)) == "around (4cm, 0cm) at 2cm/s");
}

}  // namespace
}  // namespace probe::plan
