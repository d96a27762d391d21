// The oriented box of an object, which stands for it as collision hulls are not known to the
// compiler, and its shadow on the surface, which is what overlap and edges are judged by.
#pragma once

#include <array>
#include <optional>

#include "compiler/model/model.h"
#include "runtime/base/geometry.h"
#include "runtime/scene/solid.h"

namespace probe::sema {

struct Vec2 {
  double x = 0, y = 0;  // m
};

// A centre and three half axes, of which the outline is the sum (m, world).
struct Footprint {
  Vec2 centre;
  std::array<Vec2, 3> axes;

  // Half its extent along the unit vector `n`.
  double reach_along(const Vec2& n) const;
};

Footprint footprint(const Object& object, const Start::Placed& placed);

// Whether all of it lies on an area: least x, least y, most x, most y.
bool is_inside(const Footprint& print, const std::array<double, 4>& area);

// How far the box reaches from its model's origin, however it is turned, and a little more than
// rounding takes away (m).
double reach_of(const Object& object);

// How deep two footprints stand in one another (m), over their separating axes; at most 0 when some
// line separates them.
double overlap(const Footprint& a, const Footprint& b);

// The factor by which the vector between two cells must grow until their footprints only touch;
// nothing when they stand on the same cell.
std::optional<double> growth(const Footprint& a, const Footprint& b, const Vec2& cells);

// The box of an object, turned, with its model's origin at `origin`.
scene::Solid solid(const Object& object, const Mat3& turn, const Vec3& origin);
// How far the lowest corner of a turned box lies above its model's origin (m, mostly negative).
double lowest(const Object& object, const Mat3& turn);
// The height of a turned box (m).
double height(const Object& object, const Turn& turn);

}  // namespace probe::sema
