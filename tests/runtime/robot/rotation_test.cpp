#include "runtime/robot/rotation.h"

#include <cmath>
#include <numbers>

#include <doctest/doctest.h>

namespace probe::robot {
namespace {

constexpr double kPi = std::numbers::pi;

TEST_CASE("a rotation vector goes to a quaternion and back") {
  for (const Vec3& v : {Vec3(0, 0, 0), Vec3(1e-11, 0, -1e-12), Vec3(1e-7, 2e-7, 0),
                        Vec3(0.3, -0.2, 0.1), Vec3(0, 3.0, 0), Vec3(1.8, 1.8, 1.8)}) {
    const Quat q = from_rotation_vector(v);
    CHECK(std::abs(q.norm() - 1) < 1e-15);
    CHECK((to_rotation_vector(q) - v).norm() < 1e-14);
    CHECK((to_rotation_vector(Quat(-q.w(), -q.x(), -q.y(), -q.z())) - v).norm() < 1e-14);
  }
  // Beyond half a turn the short way round comes back.
  CHECK((to_rotation_vector(from_rotation_vector(Vec3(0, 0, 1.5 * kPi))) - Vec3(0, 0, -0.5 * kPi))
            .norm() < 1e-14);
}

TEST_CASE("an axis rotation agrees with the rotation vector") {
  const Vec3 axis = Vec3(1, -2, 0.5).normalized();
  for (const double angle : {-3.0, -0.1, 0.0, 1.0, 2.5}) {
    const Mat3 expected = from_rotation_vector(axis * angle).toRotationMatrix();
    CHECK((axis_rotation(axis, angle) - expected).cwiseAbs().maxCoeff() < 1e-15);
  }
}

TEST_CASE("roll, pitch and yaw turn about x, then y, then z of the fixed frame") {
  const Mat3 m = from_rpy({0.3, -0.4, 1.2}).toRotationMatrix();
  const Mat3 expected = axis_rotation(Vec3::UnitZ(), 1.2) * axis_rotation(Vec3::UnitY(), -0.4) *
                        axis_rotation(Vec3::UnitX(), 0.3);
  CHECK((m - expected).cwiseAbs().maxCoeff() < 1e-15);
  CHECK((to_rpy(from_rpy({0.3, -0.4, 1.2})) - Vec3(0.3, -0.4, 1.2)).norm() < 1e-14);
  // At the pole only yaw - roll is known.
  const Vec3 pole = to_rpy(from_rpy({0.5, 0.5 * kPi, 0.2}));
  CHECK(pole.y() == doctest::Approx(0.5 * kPi).epsilon(1e-7));
  CHECK((from_rpy(pole).toRotationMatrix() - from_rpy({0.5, 0.5 * kPi, 0.2}).toRotationMatrix())
            .cwiseAbs()
            .maxCoeff() < 1e-7);
}

TEST_CASE("the error of two poses is a distance and an angle") {
  const Pose a{Vec3(1, 2, 3), from_rotation_vector({0, 0, 0.5})};
  const Pose b{Vec3(1, 2, 7), from_rotation_vector({0, 0, -0.25})};
  CHECK(pose_error(a, b).position == 4);
  CHECK(pose_error(a, b).rotation == doctest::Approx(0.75));
}

}  // namespace
}  // namespace probe::robot
