// The law of the reference's controller; numbers of the gripper come from the robot's record in the
// plan.
#include "runtime/robot/control.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "runtime/base/check.h"
#include "runtime/robot/action_check.h"
#include "runtime/robot/grip_command.h"
#include "runtime/robot/rotation.h"

namespace probe::robot {
Pose moved_target(const Pose& target, const Vec3& measured_position, const Vec3& shift,
                  const Vec3& rotation_vector) {
  const Quat turn = from_rotation_vector(rotation_vector);
  return {measured_position + shift + turn * (target.position - measured_position),
          (turn * target.rotation).normalized()};
}

Result<EeDeltaPoseController> EeDeltaPoseController::create(const RobotModel& model,
                                                            const EeControlSpec& spec) {
  PROBE_ASSIGN(Chain chain, Chain::create(model, spec.tcp_link, spec.arm_joints));
  if (spec.arm_joints.empty()) {
    return Failure{Fault::kUrdf, fmt::format("no joint moves the link `{}`", spec.tcp_link),
                   model.path};
  }
  EeDeltaPoseController controller(std::move(chain));
  PROBE_ASSIGN(controller.range_, finger_range(model, spec.finger_joints, opens_up(spec)));
  if (!std::isfinite(spec.grip_closed) || !std::isfinite(spec.grip_open)) {
    return Failure{Fault::kUrdf, "the gripper's targets are not finite", model.path};
  }
  controller.grip_closed_ = spec.grip_closed;
  controller.grip_open_ = spec.grip_open;
  controller.joint_targets_.assign(spec.arm_joints.size() + spec.finger_joints.size(), 0);
  controller.target_ = controller.chain_.pose(
      std::span<const double>(controller.joint_targets_).first(spec.arm_joints.size()));
  return controller;
}

void EeDeltaPoseController::reset(std::span<const double> q) {
  PROBE_CHECK(q.size() == joint_targets_.size(), "one position a drive");
  std::copy(q.begin(), q.end(), joint_targets_.begin());
  target_ = tcp_pose(q);
  reached_ = true;
}

Status EeDeltaPoseController::restore(const ControlState& state) {
  if (state.joint_targets.size() != joint_targets_.size()) {
    return Failure{Fault::kPolicy,
                   fmt::format("the controller's state is of {} joints, the robot has {}",
                               state.joint_targets.size(), joint_targets_.size()),
                   ""};
  }
  target_ = state.target;
  joint_targets_ = state.joint_targets;
  reached_ = state.reached;
  return {};
}

Pose EeDeltaPoseController::tcp_pose(std::span<const double> q) const {
  return chain_.pose(q.first(chain_.joint_count()));
}

double EeDeltaPoseController::openness(std::span<const double> q) const {
  return range_.openness(q.subspan(chain_.joint_count()));
}

Result<std::span<const double>> EeDeltaPoseController::targets(const ToolAction& action,
                                                               std::span<const double> measured_q) {
  PROBE_CHECK(measured_q.size() == joint_targets_.size(), "one measured position a drive");
  PROBE_TRY(check_tool_action(action));
  const Vec3 shift = Eigen::Map<const Vec3>(action.data() + kActionShift);
  const Vec3 turn = Eigen::Map<const Vec3>(action.data() + kActionTurn);
  target_ = moved_target(target_, tcp_pose(measured_q).position, shift, turn);

  const std::size_t arm = chain_.joint_count();
  std::array<double, kMaxChainJoints> q{};
  std::copy_n(measured_q.begin(), arm, q.begin());
  reached_ = solve_ik(chain_, target_, std::span(q).first(arm)).converged;
  if (reached_) std::copy_n(q.begin(), arm, joint_targets_.begin());

  const double grip = finger_target(grip_closed_, grip_open_, action[kActionGripper]);
  std::fill(joint_targets_.begin() + std::ptrdiff_t(arm), joint_targets_.end(), grip);
  return std::span<const double>(joint_targets_);
}

}  // namespace probe::robot
