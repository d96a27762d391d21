// An object seen from above: convex outlines of its parts, how low and how high it reaches. The
// frame is any whose z is up; the expert uses the robot base. Plain geometry, no robot.
#pragma once

#include <span>
#include <vector>

#include "runtime/base/geometry.h"

namespace probe::expert {

using Vec2 = Eigen::Vector2d;
using Outline = std::vector<Vec2>;  // convex, counter-clockwise

struct Footprint {
  std::vector<Outline> parts;
  std::vector<double> part_tops;  // one a part
  Outline whole;                  // around all parts
  Vec2 center = Vec2::Zero();     // of area, parts weighted by theirs
  double radius = 0;              // about `center`
  double bottom = 0, top = 0;     // lowest and highest vertex
};

// `parts` are vertices in the model frame, `pose` places the model. An object without vertices has
// an empty outline.
Footprint footprint_of(std::span<const std::vector<Vec3>> parts, const Pose& pose);

// Counts from another centre, such as that of mass.
void recenter(Footprint& footprint, const Vec2& center);

// Of the box around the outline, along the frame's axes.
double half_diagonal(const Footprint& footprint);

// Of all ways to turn it, the least room between two walls; 0 of a point.
double least_width(const Outline& outline);

// The convex hull of points; collinear ones are dropped.
Outline convex_outline(std::vector<Vec2> points);

// Outlines of what convex parts (vertices) have at or above a height.
std::vector<Outline> section_above(std::span<const std::vector<Vec3>> parts, double height);

// Of an outline's part with |across . p - at| <= half, the extent along `along`. Empty if lower >
// upper.
struct Extent {
  double lower = 1, upper = -1;
  bool empty() const { return lower > upper; }
  double width() const { return upper - lower; }
};
struct Slab {
  Vec2 across;  // unit
  double at = 0, half = 0;
};
Extent extent_in_slab(std::span<const Outline> parts, const Slab& slab, const Vec2& along);

// Turns (rad, -pi .. pi, within half a quarter of the nearest first) that bring the longest edge of
// `outline` along or across those edges of the others near `at` (m) that are long enough to lie
// along: what goes between walls goes in square to them.
std::vector<double> turns_square_to(const Outline& outline,
                                    std::span<const Footprint* const> others, const Vec2& at,
                                    double near);

// Distance between two outlines, negative (the depth along the best axis) where they overlap.
double separation(const Outline& a, const Outline& b);

}  // namespace probe::expert
