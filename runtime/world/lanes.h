// Sums and minima in fixed lanes: vectorised without fast-math, the same bits with any instruction
// set.
#pragma once

#include "runtime/world/state.h"

namespace probe::world {

using Lane2 = double __attribute__((vector_size(16)));

static_assert(kMaxJoints == 8, "dot_joints is written for eight lanes");

// ((0+4) + (1+5)) + ((2+6) + (3+7)).
inline double dot_joints(const JointArray& a, const JointArray& b) {
  const Lane2 p0 = Lane2{a[0], a[1]} * Lane2{b[0], b[1]} + Lane2{a[4], a[5]} * Lane2{b[4], b[5]};
  const Lane2 p1 = Lane2{a[2], a[3]} * Lane2{b[2], b[3]} + Lane2{a[6], a[7]} * Lane2{b[6], b[7]};
  return (p0[0] + p0[1]) + (p1[0] + p1[1]);
}

inline void add_scaled(JointArray* to, const JointArray& from, double factor) {
  for (std::size_t i = 0; i < kMaxJoints; ++i) (*to)[i] += from[i] * factor;
}

// Smallest n . vertex of a part.
inline double min_dot(const scene::ConvexPart& part, const Vec3& n) {
  const Lane2 nx{n.x(), n.x()}, ny{n.y(), n.y()}, nz{n.z(), n.z()};
  const double* x = part.x.data();
  const double* y = part.y.data();
  const double* z = part.z.data();
  const auto dot = [&](std::size_t i) {
    return Lane2{x[i], x[i + 1]} * nx + Lane2{y[i], y[i + 1]} * ny + Lane2{z[i], z[i + 1]} * nz;
  };
  Lane2 low = dot(0), high = dot(2);
  const std::size_t count = part.x.size();
  for (std::size_t i = 4; i < count; i += 4) {
    const Lane2 p = dot(i), q = dot(i + 2);
    low = p < low ? p : low;
    high = q < high ? q : high;
  }
  low = high < low ? high : low;
  return low[1] < low[0] ? low[1] : low[0];
}

}  // namespace probe::world
