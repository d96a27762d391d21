// Vectors, rotations and poses shared by every part. SI units, world z up, quaternions (w, x, y,
// z).
#pragma once

#include <Eigen/Dense>
#include <Eigen/Geometry>
#include <array>

namespace probe {

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;
using Quat = Eigen::Quaterniond;

inline Vec3 to_vec(const std::array<double, 3>& v) { return {v[0], v[1], v[2]}; }
// As it is stored: w, x, y, z.
inline Quat to_quat(const std::array<double, 4>& q) { return {q[0], q[1], q[2], q[3]}; }

// A rigid transform: x_parent = rotation * x_child + position. `rotation` is unit.
struct Pose {
  Vec3 position = Vec3::Zero();
  Quat rotation = Quat::Identity();

  Vec3 apply(const Vec3& point) const { return rotation * point + position; }
  Pose inverse() const {
    const Quat inv = rotation.conjugate();
    return {inv * -position, inv};
  }
};

inline Pose operator*(const Pose& a, const Pose& b) {
  return {a.rotation * b.position + a.position, a.rotation * b.rotation};
}

inline bool is_finite(const Pose& pose) {
  return pose.position.allFinite() && pose.rotation.coeffs().allFinite();
}

}  // namespace probe
