// What the arm must not touch, as upright prisms: convex outlines between two heights, with signed
// distances and their gradients. The robot base frame (z up). Over-estimates what leans.
#pragma once

#include <vector>

#include "runtime/base/geometry.h"
#include "runtime/expert/footprint.h"

namespace probe::expert {

struct Prism {
  Outline outline;  // convex, counter-clockwise
  double bottom = 0, top = 0;
  Vec2 center = Vec2::Zero();  // of a circle around the outline
  double radius = 0;
};
Prism make_prism(const Outline& outline, double bottom, double top);

struct Distance {
  double value = 0;              // m, negative inside
  Vec3 gradient = Vec3::Zero();  // by the point, unit length
};

// Of a point from a prism's surface; the outline must not be empty.
Distance distance_to(const Prism& prism, const Vec3& point);

// Prisms over a floor.
struct Obstacles {
  double floor = 0;
  std::vector<Prism> prisms;

  // The least distance of a point from the floor and the prisms, as far as it is below `beyond`;
  // else `beyond` or more, with a gradient of no meaning.
  Distance nearest(const Vec3& point, double beyond) const;
};

}  // namespace probe::expert
