#include "runtime/robot/joint_control.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "runtime/base/check.h"
#include "runtime/robot/action_check.h"
#include "runtime/robot/grip_command.h"

namespace probe::robot {

using std::size_t;

namespace {

std::string_view wanted_position(size_t number, size_t size) {
  return number + 1 == size ? "the gripper from -1 to 1" : "a joint's position";
}

std::string_view wanted_step(size_t number, size_t size) {
  return number + 1 == size ? "the gripper from -1 to 1" : "a joint's step";
}

}  // namespace

Result<JointController> JointController::read(const RobotModel& model, const EeControlSpec& spec) {
  PROBE_ASSIGN(const Chain chain, Chain::create(model, spec.tcp_link, spec.arm_joints));
  PROBE_TRY(finger_range(model, spec.finger_joints));
  JointController made;
  made.lower_.assign(chain.lower().begin(), chain.lower().end());
  made.upper_.assign(chain.upper().begin(), chain.upper().end());
  if (!std::isfinite(spec.grip_closed) || !std::isfinite(spec.grip_open)) {
    return Failure{Fault::kUrdf, "the gripper's targets are not finite", model.path};
  }
  made.grip_closed_ = spec.grip_closed;
  made.grip_open_ = spec.grip_open;
  made.targets_.assign(spec.arm_joints.size() + spec.finger_joints.size(), 0);
  return made;
}

Result<JointController> JointController::create(const RobotModel& model, const EeControlSpec& spec,
                                                JointDelta law) {
  if (!(law.most >= 0) || !std::isfinite(law.most)) {
    return Failure{Fault::kUrdf, "the largest step of `joint_delta` is negative or not finite",
                   model.path};
  }
  PROBE_ASSIGN(JointController made, read(model, spec));
  made.law_ = law;
  return made;
}

Result<JointController> JointController::create(const RobotModel& model, const EeControlSpec& spec,
                                                JointPosition) {
  PROBE_ASSIGN(JointController made, read(model, spec));
  made.absolute_ = true;
  return made;
}

void JointController::reset(std::span<const double> q) {
  PROBE_CHECK(q.size() == targets_.size(), "one position a drive");
  std::copy(q.begin(), q.end(), targets_.begin());
}

Result<std::span<const double>> JointController::targets(std::span<const double> action,
                                                         std::span<const double> measured_q) {
  const size_t arm = lower_.size();
  PROBE_CHECK(action.size() == arm + 1 && measured_q.size() == targets_.size(),
              "a number for each arm joint and one for the gripper, one position a drive");
  PROBE_TRY(check_numbers(action, absolute_ ? wanted_position : wanted_step));
  const double most = law_.most > 0 ? law_.most : std::numeric_limits<double>::infinity();
  for (size_t i = 0; i < arm; ++i) {
    const double from = absolute_ ? 0 : law_.from_target ? targets_[i] : measured_q[i];
    const double step = absolute_ ? action[i] : std::clamp(action[i], -most, most);
    targets_[i] = std::clamp(from + step, lower_[i], upper_[i]);
  }
  const double grip = finger_target(grip_closed_, grip_open_, action[arm]);
  std::fill(targets_.begin() + std::ptrdiff_t(arm), targets_.end(), grip);
  return std::span<const double>(targets_);
}

Status JointController::restore(const ControlState& state) {
  if (state.joint_targets.size() != targets_.size()) {
    return Failure{Fault::kPolicy,
                   fmt::format("the controller's state is of {} joints, the robot has {}",
                               state.joint_targets.size(), targets_.size()),
                   ""};
  }
  targets_ = state.joint_targets;
  return {};
}

}  // namespace probe::robot
