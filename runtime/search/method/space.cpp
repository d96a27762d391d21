#include "runtime/search/method/space.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "runtime/base/check.h"
#include "runtime/search/method/draws.h"

namespace probe::search {

Point own_point(const Space& space) {
  Point point;
  for (const Axis& axis : space) point.push_back(axis.own);
  return point;
}

double distance(const Axis& axis, double x) {
  switch (axis.kind) {
    case AxisKind::kContinuous:
      return std::abs(x - axis.own);
    case AxisKind::kCount:
      return axis.size < 2 ? 0 : std::abs(x - axis.own) / (axis.size - 1);
    case AxisKind::kChoice:
      return x == axis.own ? 0 : 1;
  }
  return 0;
}

double distance(const Space& space, const Point& point) {
  PROBE_CHECK(space.size() == point.size(), "a point has one number an axis");
  double sum = 0;
  for (std::size_t i = 0; i < space.size(); ++i) sum += distance(space[i], point[i]);
  return sum;
}

double uniform_on(const Axis& axis, double u) {
  if (axis.kind == AxisKind::kContinuous) return u;
  PROBE_CHECK(axis.size > 0, "a count or a choice has values");
  return std::min(std::floor(u * axis.size), static_cast<double>(axis.size - 1));
}

std::vector<Point> latin_hypercube(const Space& space, std::size_t count, std::uint64_t seed,
                                   std::string_view name) {
  Draws draws(seed, name);
  std::vector<Point> points(count, Point(space.size()));
  std::vector<std::size_t> part(count);
  for (std::size_t axis = 0; axis < space.size(); ++axis) {
    std::iota(part.begin(), part.end(), std::size_t{0});
    for (std::size_t i = count; i > 1; --i) {
      std::swap(part[i - 1], part[draws.below(static_cast<std::uint32_t>(i))]);
    }
    for (std::size_t i = 0; i < count; ++i) {
      const double u =
          (static_cast<double>(part[i]) + draws.uniform()) / static_cast<double>(count);
      points[i][axis] = uniform_on(space[axis], u);
    }
  }
  return points;
}

}  // namespace probe::search
