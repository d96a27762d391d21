#include "runtime/expert/footprint.h"

#include <cmath>
#include <numbers>

#include "tests/runtime/expert/fake_table.h"

namespace probe::expert {
namespace {

TEST_CASE("the outline of points is convex, without the inner ones") {
  const Outline o = convex_outline({{0, 0}, {2, 0}, {1, 0}, {2, 1}, {1, 0.5}, {0, 1}, {0, 0}});
  REQUIRE(o.size() == 4);
  CHECK(o[0] == Vec2(0, 0));
  CHECK(o[1] == Vec2(2, 0));  // counter-clockwise
  CHECK(convex_outline({{1, 1}}).size() == 1);
  CHECK(convex_outline({}).empty());
}

TEST_CASE("a footprint knows height, middle and extent of the object where it stands") {
  const auto object = test::object(
      "l", {test::block({0, 0, 0}, {2, 1, 1}), test::block({0, 1, 0}, {1, 3, 2})}, {10, 0, 5}, 90);
  const Footprint print = footprint_of(object.parts, object.pose);
  CHECK(print.bottom == doctest::Approx(5));
  CHECK(print.top == doctest::Approx(7));
  // Both parts have area 2, centres (1, .5) and (.5, 2); a quarter turn takes (x, y) to (-y, x).
  CHECK((print.center - Vec2(10 - 1.25, 0.75)).norm() < 1e-9);
  CHECK(half_diagonal(print) == doctest::Approx(0.5 * std::sqrt(9.0 + 4.0)));
  const Extent whole = extent_in_slab(print.parts, {Vec2(0, 1), 0.5, 0.4}, Vec2(1, 0));
  CHECK(whole.lower == doctest::Approx(7));
  CHECK(whole.upper == doctest::Approx(10));
  const Extent end = extent_in_slab(print.parts, {Vec2(0, 1), 1.6, 0.3}, Vec2(1, 0));
  CHECK(end.width() == doctest::Approx(1));
  CHECK(extent_in_slab(print.parts, {Vec2(0, 1), 9, 0.3}, Vec2(1, 0)).empty());
}

TEST_CASE("outlines apart are at their nearest points, overlapping ones have a depth") {
  const Outline a = convex_outline({{0, 0}, {1, 0}, {1, 1}, {0, 1}});
  const Outline right = convex_outline({{3, 0}, {4, 0}, {4, 1}, {3, 1}});
  const Outline corner = convex_outline({{4, 5}, {6, 5}, {6, 7}, {4, 7}});
  const Outline over = convex_outline({{0.9, 0}, {2, 0}, {2, 1}, {0.9, 1}});
  CHECK(separation(a, right) == doctest::Approx(2));
  CHECK(separation(a, corner) == doctest::Approx(5));
  CHECK(separation(a, over) == doctest::Approx(-0.1));
}

TEST_CASE("the least width is that between two walls, however they are turned") {
  CHECK(least_width(convex_outline({{0, 0}, {4, 0}, {4, 1}, {0, 1}})) == doctest::Approx(1));
  CHECK(least_width(convex_outline({{1, 0}, {2, 1}, {1, 2}, {0, 1}})) == doctest::Approx(std::sqrt(2.0)));
  CHECK(least_width({}) == 0);
}

TEST_CASE("an object without a hull is a point") {
  const Footprint print = footprint_of({}, {Vec3(1, 2, 3), Quat::Identity()});
  CHECK(print.whole.empty());
  CHECK(print.center == Vec2(1, 2));
  CHECK(half_diagonal(print) == 0);
  CHECK(print.top == 3);
}

TEST_CASE("another centre has its own radius") {
  Footprint print;
  print.whole = convex_outline({{0, 0}, {2, 0}, {2, 1}, {0, 1}});
  recenter(print, {0, 0});
  CHECK(print.center == Vec2(0, 0));
  CHECK(print.radius == doctest::Approx(std::sqrt(5.0)));
}

TEST_CASE("a section is what lies above a height") {
  // A pyramid of base 2 and height 1: half-way up it is 1 wide.
  const std::vector<std::vector<Vec3>> pyramid{
      {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}, {0, 0, 1}}};
  const auto section = section_above(pyramid, 0.5);
  REQUIRE(section.size() == 1);
  const Extent extent = extent_in_slab(section, {Vec2(0, 1), 0, 2}, Vec2(1, 0));
  CHECK(extent.lower == doctest::Approx(-0.5));
  CHECK(extent.upper == doctest::Approx(0.5));
  CHECK(section_above(pyramid, 1.5).empty());
}

TEST_CASE("turns bring the longest edge along or across the walls near by, and no others") {
  // A book along x, between walls that are turned by 20 degrees.
  const Outline book = {{-0.08, -0.01}, {0.08, -0.01}, {0.08, 0.01}, {-0.08, 0.01}};
  const double turn = 20 * std::numbers::pi / 180;
  const auto wall_at = [&](double aside) {
    const Vec2 along(std::cos(turn), std::sin(turn)), across(-along.y(), along.x());
    Footprint wall;
    wall.parts = {convex_outline({aside * across - 0.1 * along, aside * across + 0.1 * along,
                                  (aside + 0.005) * across + 0.1 * along,
                                  (aside + 0.005) * across - 0.1 * along})};
    return wall;
  };
  const Footprint near = wall_at(0.03), far = wall_at(0.3);
  const std::vector<const Footprint*> walls = {&near, &far};
  const std::vector<double> turns = turns_square_to(book, walls, Vec2::Zero(), 0.06);
  REQUIRE(turns.size() == 4);
  CHECK(turns[0] == doctest::Approx(turn));
  CHECK(turns[1] == doctest::Approx(turn + std::numbers::pi / 2));
  CHECK(turns_square_to(book, walls, Vec2(0, -0.5), 0.06).empty());
}

}  // namespace
}  // namespace probe::expert
