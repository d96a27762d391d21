// Conversions between the ways to write a rotation.
#include "runtime/robot/rotation.h"

#include <cmath>

#include "runtime/base/trig.h"

namespace probe::robot {

Quat from_rotation_vector(const Vec3& v) {
  const double angle = std::sqrt(v.squaredNorm());
  // Below this the half angle's sine is its argument to the last bit.
  if (angle < 1e-9) return Quat(1, 0.5 * v.x(), 0.5 * v.y(), 0.5 * v.z()).normalized();
  const SinCos half = portable_sincos(0.5 * angle);
  const Vec3 axis = v * (half.sin / angle);
  return Quat(half.cos, axis.x(), axis.y(), axis.z()).normalized();
}

Vec3 to_rotation_vector(const Quat& q) {
  // q and -q are one rotation; the half with w >= 0 turns by at most pi.
  const double sign = q.w() < 0 ? -1.0 : 1.0;
  const double w = sign * q.w();
  const Vec3 v = sign * q.vec();
  const double sine = std::sqrt(v.squaredNorm());
  if (sine < 1e-12) return 2.0 * v;
  return v * (2.0 * portable_atan2(sine, w) / sine);
}

Mat3 axis_rotation(const Vec3& axis, double angle) {
  const SinCos t = portable_sincos(angle);
  const double k = 1.0 - t.cos;
  const double x = axis.x(), y = axis.y(), z = axis.z();
  Mat3 r;
  r << t.cos + k * x * x, k * x * y - t.sin * z, k * x * z + t.sin * y,  //
      k * x * y + t.sin * z, t.cos + k * y * y, k * y * z - t.sin * x,   //
      k * x * z - t.sin * y, k * y * z + t.sin * x, t.cos + k * z * z;
  return r;
}

Quat from_rpy(const Vec3& rpy) {
  const SinCos r = portable_sincos(0.5 * rpy.x());
  const SinCos p = portable_sincos(0.5 * rpy.y());
  const SinCos y = portable_sincos(0.5 * rpy.z());
  return Quat(r.cos * p.cos * y.cos + r.sin * p.sin * y.sin,
              r.sin * p.cos * y.cos - r.cos * p.sin * y.sin,
              r.cos * p.sin * y.cos + r.sin * p.cos * y.sin,
              r.cos * p.cos * y.sin - r.sin * p.sin * y.cos)
      .normalized();
}

Vec3 to_rpy(const Quat& q) {
  const Mat3 m = q.toRotationMatrix();
  const double cos_pitch = std::sqrt(m(0, 0) * m(0, 0) + m(1, 0) * m(1, 0));
  const double pitch = portable_atan2(-m(2, 0), cos_pitch);
  // Straight up or down only the sum or difference of roll and yaw is defined.
  if (cos_pitch < 1e-9) return {0, pitch, portable_atan2(-m(0, 1), m(1, 1))};
  return {portable_atan2(m(2, 1), m(2, 2)), pitch, portable_atan2(m(1, 0), m(0, 0))};
}

PoseError pose_error(const Pose& a, const Pose& b) {
  return {std::sqrt((a.position - b.position).squaredNorm()),
          std::sqrt(to_rotation_vector(a.rotation * b.rotation.conjugate()).squaredNorm())};
}

}  // namespace probe::robot
