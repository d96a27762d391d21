// The half extents of a box as the judge has them. Header only.
#pragma once

#include <cmath>

#include "runtime/base/geometry.h"

namespace probe {

// Half extents along the body's own axes (the columns of `axes`, in the world), reordered so that z
// is the one nearest the vertical; x and y keep their order.
inline Vec3 upright_half(const Vec3& half, const Mat3& axes) {
  int up = 0;
  for (int axis = 1; axis < 3; ++axis) {
    if (std::abs(axes(2, axis)) > std::abs(axes(2, up))) up = axis;
  }
  if (up == 0) return {half.y(), half.z(), half.x()};
  if (up == 1) return {half.x(), half.z(), half.y()};
  return half;
}

}  // namespace probe
