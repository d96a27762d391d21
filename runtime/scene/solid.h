// Boxes that are turned anyhow: what stands in what, asked before there is a world.
#pragma once

#include <array>

#include "runtime/base/geometry.h"

namespace probe::scene {

struct Solid {
  Vec3 centre = Vec3::Zero();  // m
  std::array<Vec3, 3> axes{};  // half of each side, m

  Vec3 half_extent() const;  // of the upright box around it
};

// The box between two corners, along the axes.
Solid upright_solid(const Vec3& low, const Vec3& high);

// The same box where a frame is that it was given in.
Solid moved(const Solid& solid, const Pose& frame);

// How deep two boxes stand in one another (m), over their fifteen separating axes; at most 0 when a
// plane separates them.
double overlap(const Solid& a, const Solid& b);

}  // namespace probe::scene
