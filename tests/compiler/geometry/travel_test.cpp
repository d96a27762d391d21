#include "compiler/geometry/travel.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "tests/compiler/small_suite.h"

using namespace probe;
using namespace probe::sema;

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

TEST_CASE("a part fills all that its joint lets it reach, in steps of two millimetres") {
  const auto a = test::analyze_with_suite(test::kChest);
  REQUIRE_MESSAGE(a->codes().empty(), a->said());
  const auto travel = Travel::of(*a->model.fixtures.begin(), test::asset_root());
  REQUIRE(travel);
  // The drawer's box of 10 cm slides by 20 cm along the world's y, for the chest is turned by 90
  // degrees.
  double low = 1, high = -1, last = -1, widest = 0;
  for (const PartBox& box : travel->everywhere()) {
    if (box.part != 1) continue;
    low = std::min(low, box.solid.centre.y());
    high = std::max(high, box.solid.centre.y());
    if (last >= 0) widest = std::max(widest, box.position - last);
    last = box.position;
    CHECK(box.solid.centre.y() == doctest::Approx(0.3 + box.position));
    CHECK(box.half.x() == doctest::Approx(0.05));
  }
  CHECK(low == doctest::Approx(0.3));
  CHECK(high == doctest::Approx(0.5));
  CHECK(widest <= 0.002 + 1e-12);
  const double joints[] = {0.04, 0, 0};
  const auto begun = travel->at(joints);
  REQUIRE(begun.size() == 4);
  CHECK(begun[1].solid.centre.y() == doctest::Approx(0.34));
}
