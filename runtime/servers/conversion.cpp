// Conventions of Bridge's policies follow INT-ACT's src/experiments/env_adapters/simpler.py.
#include "runtime/servers/conversion.h"

#include <algorithm>
#include <cmath>

#include "runtime/policy/sent_prompt.h"
#include "runtime/robot/rotation.h"
#include "runtime/servers/libero_state.h"

namespace probe::servers {
namespace {

Failure bad_conversion(std::string message) { return {Fault::kPolicy, std::move(message), ""}; }

bool is_masked(const Statistics& statistics, std::size_t i) {
  return i < statistics.mask.size() && statistics.mask[i] == 0;
}

// How many numbers it is of.
std::size_t size_of(const Statistics& statistics) {
  return statistics.kind == Normalisation::kGaussian ? statistics.mean.size()
                                                     : statistics.low.size();
}

// The tool's rotation when it points down, from which BridgeData counts.
Quat top_down() {
  Mat3 rotation;
  rotation << 0, 0, 1, 0, 1, 0, -1, 0, 0;
  return Quat(rotation);
}

// The range of a gripper's number: its closed and its open end.
struct Ends {
  double closed, open;
};
Ends ends_of(GripperRange range) {
  switch (range) {
    case GripperRange::kUnit:
      return {0, 1};
    case GripperRange::kSignedInverted:
    case GripperRange::kStepInverted:
      return {1, -1};
    case GripperRange::kUnitInverted:
      return {1, 0};
    case GripperRange::kSigned:
    case GripperRange::kStep:
      break;
  }
  return {-1, 1};
}

Result<double> to_gripper(const Profile& profile, double raw) {
  const Ends ends = ends_of(profile.action_gripper);
  const double low = std::min(ends.closed, ends.open), high = std::max(ends.closed, ends.open);
  // Regression overshoots; more than a whole range is another convention.
  const double slack = high - low;
  if (raw < low - slack || raw > high + slack) {
    return bad_conversion("the gripper's number is " + std::to_string(raw) + ", expected " +
                          std::to_string(static_cast<int>(low)) + " to " +
                          std::to_string(static_cast<int>(high)) +
                          " (profile fields `action.gripper`, `action.normalised`)");
  }
  if (profile.action_threshold) {
    const bool above = raw > *profile.action_threshold;
    return above == (ends.open > ends.closed) ? 1.0 : -1.0;
  }
  const double open = profile.action_gripper == GripperRange::kSigned
                          ? raw
                          : 2 * (raw - ends.closed) / (ends.open - ends.closed) - 1;
  return std::clamp(open, -1.0, 1.0);
}

double length(const double* numbers) {
  return std::sqrt(numbers[0] * numbers[0] + numbers[1] * numbers[1] + numbers[2] * numbers[2]);
}

Status check_limit(double value, double limit, const char* what, const char* unit,
                   const char* field) {
  if (value <= limit) return {};
  return bad_conversion(std::string("an action that ") + what + " " + std::to_string(value) + " " +
                        unit + " in one control step, expected at most " + std::to_string(limit) +
                        " (profile fields `action.normalised`, `" + field + "`)");
}

double share_of(double number) { return std::clamp(number, -1.0, 1.0); }

// Three numbers that are a share of what the robot does in a step, held to it.
void scale(ActionUnits units, double unit, double* numbers) {
  const double size = length(numbers);
  const double shorter = units == ActionUnits::kBall && size > 1 ? 1 / size : 1;
  for (int i = 0; i < 3; ++i) {
    const double share = units == ActionUnits::kBox ? share_of(numbers[i]) : numbers[i] * shorter;
    numbers[i] = share * unit;
  }
}

// The pose that an absolute action asks for.
Pose pose_of(const Profile& profile, const RawAction& a) {
  const Vec3 at(a[0], a[1], a[2]), angles(a[3], a[4], a[5]);
  return {at, profile.action_rotation == RotationForm::kEuler
                  ? robot::from_rpy(angles)
                  : robot::from_rotation_vector(angles)};
}

// rad; farther outside a joint's limits than policies overshoot.
constexpr double kBeyondJoint = 0.5;

// Where the joints asked for are to be.
Result<std::vector<double>> asked_joints(const Profile& profile, const RawAction& numbers,
                                         const ArmNow& arm) {
  const std::size_t count = numbers.size() - 1;
  if (arm.chain == nullptr || arm.chain->joint_count() != count || arm.joints.size() != count) {
    return bad_conversion("an action of " + std::to_string(count) +
                          " joints and a gripper, for an arm of " +
                          std::to_string(arm.joints.size()) + " (profile field `action.form`)");
  }
  std::vector<double> joints(numbers.begin(), numbers.end() - 1);
  for (std::size_t i = 0; i < count; ++i) {
    if (profile.action_form == ActionForm::kJointSteps) joints[i] += arm.joints[i];
    const double low = arm.chain->lower()[i], high = arm.chain->upper()[i];
    if (joints[i] < low - kBeyondJoint || joints[i] > high + kBeyondJoint) {
      return bad_conversion("joint " + std::to_string(i + 1) + " is to be at " +
                            std::to_string(joints[i]) + " rad, its limits are " +
                            std::to_string(low) + " and " + std::to_string(high) +
                            " (profile fields `action.form`, `action.units`)");
    }
    joints[i] = std::clamp(joints[i], low, high);
  }
  return joints;
}

// The numbers of an arm that is told its joints, the gripper's left to do.
Result<policy::Action> joint_action(const Profile& profile, const RawAction& numbers,
                                    const ArmNow& arm) {
  const ActionForm wanted = arm.space->layout == robot::ActionLayout::kJoints
                                ? ActionForm::kJoints
                                : ActionForm::kJointSteps;
  if (profile.action_form != wanted) {
    return bad_conversion(std::string("the robot is told ") +
                          (wanted == ActionForm::kJoints ? "positions" : "steps") +
                          " of its joints, and the actions are none (profile field `action.form`)");
  }
  if (auto good = asked_joints(profile, numbers, arm); !good) return good.failure();
  return policy::Action(std::span<const double>(numbers));
}

// The pose to be at as the change that brings the controller's target there. Its law is T' =
// Trans(p) [R, d] Trans(-p) T with p the measured position, so R = R' R_T^-1 and d = t' - p - R (t
// - p).
void set_change(const Pose& wanted, const ArmNow& arm, robot::ToolAction* action) {
  const Quat turn = wanted.rotation * arm.target.rotation.conjugate();
  const Vec3& from = arm.tool_measured;
  const Vec3 shift = wanted.position - from - turn * (arm.target.position - from);
  const Vec3 vector = robot::to_rotation_vector(turn);
  for (int i = 0; i < 3; ++i) {
    (*action)[static_cast<std::size_t>(i)] = shift[i];
    (*action)[static_cast<std::size_t>(i + 3)] = vector[i];
  }
}

double denormalised(const Statistics& statistics, std::size_t i, double value) {
  if (is_masked(statistics, i) || i >= size_of(statistics)) return value;
  switch (statistics.kind) {
    case Normalisation::kBound:
      return (value + 1) / 2 * (statistics.high[i] - statistics.low[i]) + statistics.low[i];
    case Normalisation::kGaussian:
      return value * statistics.std[i] + statistics.mean[i];
    case Normalisation::kNone:
      break;
  }
  return value;
}

double normalised(const Statistics& statistics, std::size_t i, double value) {
  if (is_masked(statistics, i)) return value;
  switch (statistics.kind) {
    case Normalisation::kBound: {
      const double low = statistics.low[i], high = statistics.high[i];
      return std::clamp(2 * (value - low) / (high - low) - 1, -1.0, 1.0);
    }
    case Normalisation::kGaussian:
      return (value - statistics.mean[i]) / statistics.std[i];
    case Normalisation::kNone:
      break;
  }
  return value;
}

void append(std::vector<double>& numbers, const Vec3& v) {
  numbers.insert(numbers.end(), {v.x(), v.y(), v.z()});
}

// Statistics have a number for each of an action's; how many those are the robot's joints say.
Status check_statistics(const Profile& profile, std::size_t numbers) {
  const std::size_t given = size_of(profile.action_statistics);
  if (profile.action_statistics.kind == Normalisation::kNone || given == numbers) return {};
  return bad_conversion("the profile's statistics are of " + std::to_string(given) +
                        " numbers, an action has " + std::to_string(numbers) +
                        " (profile field `action.normalised`)");
}

Result<std::vector<double>> laid_out(const Profile& profile, StateLayout layout,
                                     const policy::Proprioception& measured, const Pose& base) {
  Quat rotation = measured.tcp_in_base.rotation;
  if (profile.state_frame == StateFrame::kTopDown) rotation = rotation * top_down().conjugate();
  // One sign of the two, so that equal rotations are equal numbers.
  if (rotation.w() < 0) rotation.coeffs() = -rotation.coeffs();
  std::vector<double> state;
  const bool has_pose =
      layout >= StateLayout::kXyzWxyzOpenness && layout <= StateLayout::kXyzRotvecFingers;
  if (has_pose) append(state, measured.tcp_in_base.position);
  const std::vector<double>& joints = measured.joints;
  const bool has_fingers = measured.arm_joints() < joints.size();
  const auto first_finger = joints.begin() + static_cast<std::ptrdiff_t>(measured.arm_joints());
  switch (layout) {
    case StateLayout::kNone:
      break;
    case StateLayout::kXyzWxyzOpenness:
      state.insert(state.end(), {rotation.w(), rotation.x(), rotation.y(), rotation.z()});
      state.push_back(measured.openness);
      break;
    case StateLayout::kXyzRpyOpenness:
    case StateLayout::kXyzRpyPadOpenness:
      append(state, robot::to_rpy(rotation));
      if (layout == StateLayout::kXyzRpyPadOpenness) state.push_back(0);
      state.push_back(measured.openness);
      break;
    case StateLayout::kXyzRotvecOpenness:
      append(state, robot::to_rotation_vector(rotation));
      state.push_back(measured.openness);
      break;
    case StateLayout::kXyzXyzwClosedness:
      state.insert(state.end(), {rotation.x(), rotation.y(), rotation.z(), rotation.w()});
      state.push_back(1 - measured.openness);
      break;
    case StateLayout::kXyzRotvecFingers:
      append(state, robot::to_rotation_vector(rotation));
      if (!has_fingers)
        return bad_conversion("`state.layout` asks for fingers, the robot has none");
      state.insert(state.end(), first_finger, joints.end());
      break;
    case StateLayout::kJoints:
      state = joints;
      break;
    case StateLayout::kJointsOpenness:
    case StateLayout::kArmJoints:
      if (!has_fingers)
        return bad_conversion("`state.layout` leaves out the fingers, the robot has none");
      state.assign(joints.begin(), first_finger);
      if (layout == StateLayout::kJointsOpenness) state.push_back(measured.openness);
      break;
    case StateLayout::kFingers:
      if (!has_fingers) return bad_conversion("`state.more` asks for fingers, the robot has none");
      state.assign(first_finger, joints.end());
      break;
    case StateLayout::kOpenness:
      state = {measured.openness};
      break;
    case StateLayout::kClosedness:
      state = {1 - measured.openness};
      break;
    case StateLayout::kLibero:
      return libero_state(measured, base);
  }
  return state;
}

}  // namespace

std::string to_prompt(const Profile& profile, std::string_view prompt) {
  // Other ways to write it: policy::can_be_sent_as has to know them too.
  std::string text(prompt);
  if (profile.prompt_case == PromptCase::kLower) text = policy::in_lower_case(std::move(text));
  switch (profile.prompt_full_stop) {
    case FullStop::kWith:
      return policy::with_full_stop(std::move(text));
    case FullStop::kWithout:
      return policy::without_full_stop(std::move(text));
    case FullStop::kAsIs:
      break;
  }
  return text;
}

Result<std::vector<double>> to_state(const Profile& profile, const policy::Proprioception& measured,
                                     const Pose& base) {
  PROBE_ASSIGN(std::vector<double> state, laid_out(profile, profile.state_layout, measured, base));
  const Statistics& statistics = profile.state_statistics;
  if (statistics.kind == Normalisation::kNone) return state;
  const std::size_t known = size_of(statistics);
  if (known != state.size()) {
    return bad_conversion("the profile has statistics of " + std::to_string(known) +
                          " numbers, the state has " + std::to_string(state.size()));
  }
  for (std::size_t i = 0; i < state.size(); ++i) state[i] = normalised(statistics, i, state[i]);
  return state;
}

Result<std::vector<double>> to_state(const Profile& profile, StateLayout layout,
                                     const policy::Proprioception& measured, const Pose& base) {
  return laid_out(profile, layout, measured, base);
}

RawAction denormalised(const Profile& profile, const RawAction& raw) {
  RawAction action = raw;
  if (names_joints(profile.action_form) && profile.action_units == ActionUnits::kBox) {
    for (std::size_t i = 0; i + 1 < action.size(); ++i)
      action[i] = share_of(action[i]) * profile.action_scale_rad;
    return action;
  }
  if (profile.action_units == ActionUnits::kBox || profile.action_units == ActionUnits::kBall) {
    scale(profile.action_units, profile.action_scale_m, action.data());
    scale(profile.action_units, profile.action_scale_rad, action.data() + 3);
    return action;
  }
  for (std::size_t i = 0; i < action.size(); ++i) {
    action[i] = denormalised(profile.action_statistics, i, action[i]);
  }
  return action;
}

Result<policy::Action> to_action(const Profile& profile, const RawAction& raw, const ArmNow& arm) {
  if (auto fit = check_statistics(profile, raw.size()); !fit) return fit.failure();
  const RawAction numbers = denormalised(profile, raw);
  if (arm.space != nullptr && arm.space->is_of_joints()) {
    PROBE_ASSIGN(policy::Action joints, joint_action(profile, numbers, arm));
    PROBE_ASSIGN(joints.gripper(), to_gripper(profile, numbers.back()));
    return joints;
  }
  robot::ToolAction action{};
  const bool are_joints = names_joints(profile.action_form);
  const bool is_absolute = profile.action_form == ActionForm::kAbsolute;
  if (are_joints) {
    PROBE_ASSIGN(const std::vector<double> joints, asked_joints(profile, numbers, arm));
    set_change(arm.chain->pose(joints), arm, &action);
  } else if (is_absolute) {
    set_change(pose_of(profile, numbers), arm, &action);
  } else {
    std::copy_n(numbers.begin(), robot::kActionGripper, action.begin());
  }
  PROBE_TRY(check_limit(length(action.data()), profile.action_limit_m, "shifts by", "m",
                        "action.limit_m"));
  PROBE_TRY(check_limit(length(action.data() + 3), profile.action_limit_rad, "turns by", "rad",
                        "action.limit_rad"));
  if (profile.action_rotation == RotationForm::kEuler && !is_absolute && !are_joints) {
    const Vec3 turn = robot::to_rotation_vector(robot::from_rpy({action[3], action[4], action[5]}));
    for (int i = 0; i < 3; ++i) action[static_cast<std::size_t>(i + 3)] = turn[i];
  }
  PROBE_ASSIGN(action[robot::kActionGripper], to_gripper(profile, numbers.back()));
  return policy::Action(action);
}

}  // namespace probe::servers
