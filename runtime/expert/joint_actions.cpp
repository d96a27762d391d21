#include "runtime/expert/joint_actions.h"

#include <algorithm>
#include <variant>

#include "runtime/base/check.h"

namespace probe::expert {

JointActions::JointActions(robot::EeDeltaPoseController tool, const robot::Law& law,
                           std::size_t arm)
    : tool_(std::move(tool)),
      are_positions_(std::holds_alternative<robot::JointPosition>(law)),
      told_(arm) {
  if (const auto* steps = std::get_if<robot::JointDelta>(&law)) law_ = *steps;
}

Result<JointActions> JointActions::create(const robot::Robot& robot) {
  PROBE_CHECK(robot::row_of(robot.law).per_joint, "a law of joints");
  PROBE_ASSIGN(auto tool, robot::EeDeltaPoseController::create(*robot.model, robot.control));
  return JointActions(std::move(tool), robot.law, robot.control.arm_joints.size());
}

void JointActions::begin(std::span<const double> joints) {
  tool_.reset(joints);
  std::copy_n(joints.begin(), told_.size(), told_.begin());
}

Result<policy::Action> JointActions::act(const robot::ToolAction& step,
                                         std::span<const double> joints) {
  PROBE_TRY(tool_.targets(step, joints));
  gripper_ = step[robot::kActionGripper];
  return go_on(joints);
}

policy::Action JointActions::go_on(std::span<const double> joints) {
  const std::span<const double> targets = tool_.last();
  policy::Action action = policy::Action::zeros(told_.size() + 1);
  action.gripper() = gripper_;
  for (std::size_t i = 0; i < told_.size(); ++i) {
    const double from = are_positions_ ? 0 : law_.from_target ? told_[i] : joints[i];
    const double way = targets[i] - from;
    action[i] = law_.most > 0 ? std::clamp(way, -law_.most, law_.most) : way;
    told_[i] = from + action[i];
  }
  return action;
}

}  // namespace probe::expert
