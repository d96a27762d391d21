#include "runtime/servers/libero_state.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "runtime/base/trig.h"

namespace probe::servers {
namespace {

// The turn of each of the Panda's seven links in the one before, and of its hand in the last (w x y
// z): robosuite's models/assets/robots/panda/robot.xml. Written out, as which of two quaternions a
// turn is follows from the way in which they are multiplied.
constexpr double kHalf = 0.70710678118654757;
constexpr std::array<std::array<double, 4>, 7> kLinks = {{{1, 0, 0, 0},
                                                          {kHalf, -kHalf, 0, 0},
                                                          {kHalf, kHalf, 0, 0},
                                                          {kHalf, kHalf, 0, 0},
                                                          {kHalf, -kHalf, 0, 0},
                                                          {kHalf, kHalf, 0, 0},
                                                          {kHalf, kHalf, 0, 0}}};
constexpr std::array<double, 4> kHand = {0.924, 0, 0, -0.383};  // there of length 1.0002

Quat quat(const std::array<double, 4>& q) { return Quat(q[0], q[1], q[2], q[3]).normalized(); }

// robosuite's quat2axisangle.
Vec3 axis_times_angle(const Quat& turn) {
  const double w = std::clamp(turn.w(), -1.0, 1.0);
  const double sine = std::sqrt(1 - w * w);
  if (sine < 1e-9) return Vec3::Zero();
  return turn.vec() * (2 * portable_acos(w) / sine);
}

}  // namespace

Result<std::vector<double>> libero_state(const policy::Proprioception& measured, const Pose& base) {
  const std::size_t fingers = measured.joints.size() - measured.arm_joints();
  if (measured.arm_joints() != kLinks.size() || fingers != 2) {
    return Failure{Fault::kPolicy,
                   "`state.layout = libero` is of a Panda: seven joints and two fingers, the robot "
                   "has " +
                       std::to_string(measured.arm_joints()) + " and " + std::to_string(fingers),
                   ""};
  }
  Quat turn = base.rotation;
  for (std::size_t i = 0; i < kLinks.size(); ++i) {
    const SinCos half = portable_sincos(measured.joints[i] / 2);
    turn = turn * quat(kLinks[i]) * Quat(half.cos, 0, 0, half.sin);
  }
  const Vec3 place = base.position + base.rotation * measured.tcp_in_base.position;
  const Vec3 vector = axis_times_angle(turn * quat(kHand));
  return std::vector<double>{place.x(),  place.y(),  place.z(),          vector.x(),
                             vector.y(), vector.z(), measured.joints[7], -measured.joints[8]};
}

}  // namespace probe::servers
