// The space that is searched, as numbers: axes of three kinds and points on them. Knows nothing of
// what an axis changes; the caller maps its numbers to quantities, counts and phrases.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

namespace probe::search {

enum class AxisKind : std::uint8_t {
  kContinuous,  // 0..1
  kCount,       // 0..size-1, in an order that means something
  kChoice,      // 0..size-1, no order
};

struct Axis {
  AxisKind kind = AxisKind::kContinuous;
  int size = 0;    // of counts and choices, 1 at least; nothing of a continuous axis
  double own = 0;  // the task's own value
};

using Space = std::vector<Axis>;
using Point = std::vector<double>;  // one number an axis; whole for counts and choices

// The task itself.
Point own_point(const Space& space);

// How far `x` lies from the own value of `axis`, 0..1: of a continuous axis the difference, of a
// count the difference in steps over size-1, of a choice 1 if it is another.
double distance(const Axis& axis, double x);

// The sum over the axes, 0..axes.
double distance(const Space& space, const Point& point);

// Where `u` in (0, 1), drawn uniformly, lies on `axis`.
double uniform_on(const Axis& axis, double u);

// `count` points over all of `space`: a Latin hypercube sample (McKay, Beckman, Conover 1979), each
// axis cut into `count` equal parts with one point each, the parts paired at random.
std::vector<Point> latin_hypercube(const Space& space, std::size_t count, std::uint64_t seed,
                                   std::string_view name);

}  // namespace probe::search
