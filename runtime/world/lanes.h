// Sums and minima in fixed lanes: vectorised without fast-math, the same bits with any instruction
// set.
#pragma once

#include "runtime/world/state.h"

namespace probe::world {

using Lane2 = double __attribute__((vector_size(16)));

// The width of rows of a robot with `joints` positions.
inline int padded_lanes(int joints) { return (joints + 3) / 4 * 4; }

// Calls f with the number of lanes, as a constant where it is the usual eight.
template <typename F>
inline auto with_lanes(int lanes, F f) {
  if (lanes == 8) return f(std::integral_constant<int, 8>{});
  return f(lanes);
}

// ((0+4+..) + (1+5+..)) + ((2+6+..) + (3+7+..)); a multiple of 4 lanes.
inline double dot_joints(const double* a, const double* b, int lanes) {
  Lane2 low{0, 0}, high{0, 0};
  for (int i = 0; i < lanes; i += 4) {
    low += Lane2{a[i], a[i + 1]} * Lane2{b[i], b[i + 1]};
    high += Lane2{a[i + 2], a[i + 3]} * Lane2{b[i + 2], b[i + 3]};
  }
  return (low[0] + low[1]) + (high[0] + high[1]);
}

inline void add_scaled(double* to, const double* from, double factor, int lanes) {
  for (int i = 0; i < lanes; ++i) to[i] += from[i] * factor;
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
