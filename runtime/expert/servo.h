// From "the tool should go there" to the seven numbers of an action. The controller adds each
// action to a target pose of its own, so the servo keeps the same sum; and the arm only covers part
// of the way to a target in a control step, so the target is set ahead of where the tool shall be
// next.
#pragma once

#include "runtime/base/geometry.h"
#include "runtime/policy/policy.h"

namespace probe::expert {

struct Pace {
  double shift = 0.05;  // m a control step
  double turn = 0.30;   // rad a control step
  // 1 / the share of the way a drive covers in a control step: the WidowX's time constants are
  // 0.16-0.28 s, so 0.5-0.7.
  double lead = 1.6;
  // What the target may move in one action. The drives are stiff: a jump of the target is a jump of
  // the speed.
  double jump = 0.08;
};

class Servo {
 public:
  // The controller's target at the start of an episode is the tool's pose.
  void begin(const Pose& tcp) { target_ = tcp; }

  // Moves towards a goal, at most a pace a step. `gripper` is the action's seventh number.
  policy::Action toward(const Pose& goal, const Pose& measured, double gripper, const Pace& pace);

  // Sets the target to a pose near by, and to nothing beyond it.
  policy::Action settle(const Pose& pose, const Pose& measured, double gripper);

  // Leaves the target where it is.
  policy::Action hold(double gripper) const;

  const Pose& target() const { return target_; }

 private:
  policy::Action set_target(const Pose& wanted, const Pose& measured, double gripper, double jump);
  Pose target_;
};

// `from` moved towards `to`, no more than the given shift and turn.
Pose stepped(const Pose& from, const Pose& to, double shift, double turn);

}  // namespace probe::expert
