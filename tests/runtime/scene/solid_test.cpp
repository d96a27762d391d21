#include "runtime/scene/solid.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace probe;
using namespace probe::scene;

namespace {

Solid cube(const Vec3& centre, double half, const Mat3& turn = Mat3::Identity()) {
  return {centre, {turn.col(0) * half, turn.col(1) * half, turn.col(2) * half}};
}

}  // namespace

TEST_CASE("boxes overlap by the least way that would part them") {
  const Solid one = cube({0, 0, 0}, 1);
  CHECK(overlap(one, cube({1.5, 0, 0}, 1)) == doctest::Approx(0.5));
  CHECK(overlap(one, cube({1.5, 1.9, 0.2}, 1)) == doctest::Approx(0.1));
  CHECK(overlap(one, cube({0, 0, 2}, 1)) == doctest::Approx(0));
  CHECK(overlap(one, cube({0, 0, 2.5}, 1)) == doctest::Approx(-0.5));
  // Turned by 45 degrees about z its corner reaches sqrt(2) along x.
  Mat3 turn;
  const double c = std::sqrt(0.5);
  turn << c, -c, 0, c, c, 0, 0, 0, 1;
  CHECK(overlap(one, cube({2.4, 0, 0}, 1, turn)) == doctest::Approx(1 + std::sqrt(2) - 2.4));
}

TEST_CASE("two crossed edges are parted by the plane between them, which no face has") {
  const double c = std::sqrt(0.5);
  Mat3 about_x, about_y;
  about_x << 1, 0, 0, 0, c, -c, 0, c, c;
  about_y << c, 0, c, 0, 1, 0, -c, 0, c;
  // Ridges along x and along y, sqrt(2) high each.
  const double gap = 0.1;
  const Solid low = cube({0, 0, 0}, 1, about_x);
  const Solid high = cube({0, 0, 2 * std::sqrt(2) + gap}, 1, about_y);
  CHECK(overlap(low, high) == doctest::Approx(-gap));
}
