// Rotations as quaternions, rotation vectors and roll-pitch-yaw. All sines come from base/trig.h,
// so that poses have the same bits on every machine; Eigen's AngleAxis and slerp call the C library
// and are not used.
#pragma once

#include "runtime/base/geometry.h"

namespace probe::robot {

// Rotation by |v| radians about v.
Quat from_rotation_vector(const Vec3& v);

// The shortest one, |v| <= pi.
Vec3 to_rotation_vector(const Quat& q);

// About a unit axis, radians.
Mat3 axis_rotation(const Vec3& axis, double angle);

// URDF's convention: Rz(yaw) Ry(pitch) Rx(roll), radians.
Quat from_rpy(const Vec3& rpy);

// Pitch in [-pi/2, pi/2]; at its ends roll is 0.
Vec3 to_rpy(const Quat& q);

// How far apart two poses are: metres between origins, radians of the rotation between them.
struct PoseError {
  double position = 0;
  double rotation = 0;
};
PoseError pose_error(const Pose& a, const Pose& b);

}  // namespace probe::robot
