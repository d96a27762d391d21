#include "runtime/robot/turning_fingers.h"

#include <doctest/doctest.h>

#include <cmath>

#include "runtime/robot/robot.h"

namespace probe::robot {
namespace {

// Closed, and open by 4 cm to each side with tips 2 cm higher; faces lean out towards the palm.
TurningFingers two_openings() {
  FingersAt closed, open;
  closed.tip_below = 0.01;
  open.openness = 1;
  open.gap_half = 0.04;
  open.tip_below = -0.01;
  for (std::size_t i = 0; i < FingersAt::kHeights; ++i) {
    const double up = static_cast<double>(i) / (FingersAt::kHeights - 1);
    closed.inner[i] = 0.01 * up;
    closed.outer[i] = 0.01 + 0.01 * up;
    open.inner[i] = 0.04 + 0.01 * up;
    open.outer[i] = 0.06;
  }
  return {closed, open};
}

TEST_CASE("between two openings that were measured fingers stand between") {
  const FingersAt half = fingers_at(two_openings(), 0.5);
  CHECK(half.gap_half == doctest::Approx(0.02));
  CHECK(half.tip_below == doctest::Approx(0));
  CHECK(half.inner.front() == doctest::Approx(0.02));
  CHECK(half.outer.back() == doctest::Approx(0.04));
  CHECK(openness_of_gap(two_openings(), 0.02) == doctest::Approx(0.5));
}

TEST_CASE("beyond what was measured fingers are as at the end") {
  CHECK(fingers_at(two_openings(), 1.5).gap_half == doctest::Approx(0.04));
  CHECK(fingers_at(two_openings(), -1).tip_below == doctest::Approx(0.01));
  CHECK(openness_of_gap(two_openings(), 1) == doctest::Approx(1));
}

TEST_CASE("a finger's inner face ends at its tip, its outer one is taken to go on") {
  const FingersAt closed = two_openings().front();
  CHECK(std::isinf(inner_face(closed, 0.05, 0.011)));
  CHECK(inner_face(closed, 0.05, 0.01) == doctest::Approx(0));
  CHECK(inner_face(closed, 0.05, -0.05) == doctest::Approx(0.01));
  CHECK(outer_face(closed, 0.05, 0.02) == doctest::Approx(0.01));
  CHECK(outer_face(closed, 0.05, -0.02) == doctest::Approx(0.015));
}

TEST_CASE("a hand whose fingers turn knows its gap from their table, another in proportion") {
  HandShape slides, turns;
  slides.opening_half = 0.05;
  turns.opening_half = 0.03;
  turns.turning = two_openings();
  CHECK(slides.gap_at(0.5) == 0.025);
  CHECK(slides.openness_for(0.025) == 0.5);
  CHECK(turns.gap_at(0.5) == doctest::Approx(0.02));
  CHECK(turns.openness_for(0.02) == doctest::Approx(0.5));
  CHECK(turns.opened_by(0.5, 0.01) == doctest::Approx(0.75));
  CHECK(slides.widest_on_way(1, 0.5) == 0.05);
  CHECK(turns.widest_on_way(1, 0.5) == doctest::Approx(0.02));
}

}  // namespace
}  // namespace probe::robot
