#include "runtime/search/method/space.h"

#include <doctest/doctest.h>

#include <cmath>
#include <set>

namespace probe::search {
namespace {

const Space kSpace = {
    {AxisKind::kContinuous, 0, 0.25}, {AxisKind::kCount, 5, 1}, {AxisKind::kChoice, 3, 2}};

}  // namespace

TEST_CASE("the own point is nowhere changed, and each axis adds its own distance") {
  CHECK(distance(kSpace, own_point(kSpace)) == 0);
  CHECK(distance(kSpace, {0.75, 4, 0}) == doctest::Approx(0.5 + 0.75 + 1));
}

TEST_CASE("a Latin hypercube has one point in every part of every axis, the same for one seed") {
  const auto points = latin_hypercube(kSpace, 60, 5, "a");
  REQUIRE(points.size() == 60);
  std::set<int> parts;
  std::vector<int> counts(5), choices(3);
  for (const Point& point : points) {
    parts.insert(static_cast<int>(std::floor(point[0] * 60)));
    ++counts[static_cast<std::size_t>(point[1])];
    ++choices[static_cast<std::size_t>(point[2])];
  }
  CHECK(parts.size() == 60);
  for (const int count : counts) CHECK(count == 12);
  for (const int count : choices) CHECK(count == 20);
  CHECK(points == latin_hypercube(kSpace, 60, 5, "a"));
  CHECK(points != latin_hypercube(kSpace, 60, 6, "a"));
  CHECK(points != latin_hypercube(kSpace, 60, 5, "b"));
}

}  // namespace probe::search
