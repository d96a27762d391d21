// The inverse of the control law: which action moves the controller's target from the present one
// to the wanted one.
#include "runtime/expert/servo.h"

#include <algorithm>

#include "runtime/robot/control.h"
#include "runtime/robot/rotation.h"

namespace probe::expert {
namespace {

constexpr double kLargestTurn = 0.45;  // rad, of the target in one action

double share(double length, double most) { return length > most ? most / length : 1.0; }

}  // namespace

Pose stepped(const Pose& from, const Pose& to, double shift, double turn) {
  const Vec3 way = to.position - from.position;
  const Vec3 rotation = robot::to_rotation_vector(to.rotation * from.rotation.conjugate());
  return {from.position + way * share(way.norm(), shift),
          (robot::from_rotation_vector(rotation * share(rotation.norm(), turn)) * from.rotation)
              .normalized()};
}

policy::Action Servo::toward(const Pose& goal, const Pose& measured, double gripper,
                             const Pace& pace) {
  const Pose next = stepped(measured, goal, pace.shift, pace.turn);
  const Vec3 turn = robot::to_rotation_vector(next.rotation * measured.rotation.conjugate());
  const Pose ahead{
      measured.position + pace.lead * (next.position - measured.position),
      (robot::from_rotation_vector(pace.lead * turn) * measured.rotation).normalized()};
  return set_target(ahead, measured, gripper, pace.jump);
}

policy::Action Servo::settle(const Pose& pose, const Pose& measured, double gripper) {
  return set_target(pose, measured, gripper, Pace{}.jump);
}

policy::Action Servo::hold(double gripper) const { return {0, 0, 0, 0, 0, 0, gripper}; }

policy::Action Servo::set_target(const Pose& wanted, const Pose& measured, double gripper,
                                 double jump) {
  const Pose next = stepped(target_, wanted, jump, kLargestTurn);
  const Quat turn = next.rotation * target_.rotation.conjugate();
  const Vec3 rotation = robot::to_rotation_vector(turn);
  // The controller turns the target about the measured position; the shift makes up for what that
  // moves.
  const Vec3 swung = measured.position +
                     robot::from_rotation_vector(rotation) * (target_.position - measured.position);
  const Vec3 shift = next.position - swung;
  target_ = robot::moved_target(target_, measured.position, shift, rotation);
  return {shift.x(), shift.y(), shift.z(), rotation.x(), rotation.y(), rotation.z(), gripper};
}

}  // namespace probe::expert
