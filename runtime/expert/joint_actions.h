// A tool's step as the numbers of an arm that is told its joints. The joints that a step is for are
// those that `ee_delta_pose` would aim at: its own law finds them, by the same inverse kinematics,
// from the same measured joints. A `joint_position` is told those positions; a `joint_delta` the
// way to them from where its law counts, so that both arms get the targets that a tool's law would
// have given them, but for steps that the law clips. At high rates drives get several control steps
// to come to them, as they would at five a second.
#pragma once

#include <span>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/policy/policy.h"
#include "runtime/robot/control.h"
#include "runtime/robot/robot.h"

namespace probe::expert {

class JointActions {
 public:
  // Of a robot whose law is per joint; fails (kUrdf) as a controller does.
  static Result<JointActions> create(const robot::Robot& robot);

  // A new episode at the measured joints, drive order.
  void begin(std::span<const double> joints);

  // Once a control step. Where no joint positions bring the tool there, the arm is told to stay.
  // Fails (kPolicy) on a step that means nothing.
  Result<policy::Action> act(const robot::ToolAction& step, std::span<const double> joints);
  // Between decisions, after act(): on to the targets that the last step was for.
  policy::Action go_on(std::span<const double> joints);

 private:
  JointActions(robot::EeDeltaPoseController tool, const robot::Law& law, std::size_t arm);

  robot::EeDeltaPoseController tool_;
  bool are_positions_ = false;
  robot::JointDelta law_;     // of steps
  double gripper_ = 1;        // as it was told last
  std::vector<double> told_;  // the arm's targets, as its law has them from what it was told
};

}  // namespace probe::expert
