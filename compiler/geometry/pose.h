// A record's numbers as poses and axes.
#pragma once

#include <array>

#include "compiler/model/model.h"
#include "runtime/base/geometry.h"

namespace probe::sema {

// `position` in m; the quaternion (w, x, y, z) is made a unit one.
inline Pose pose_of(const std::array<double, 3>& position, const std::array<double, 4>& rotation) {
  return {to_vec(position), to_quat(rotation).normalized()};
}

// The axes of what is turned so, as columns.
inline Mat3 axes_of(const Turn& turn) {
  return pose_of({}, turn.rotation).rotation.toRotationMatrix();
}

}  // namespace probe::sema
