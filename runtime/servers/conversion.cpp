// Conventions of Bridge's policies follow INT-ACT's src/experiments/env_adapters/simpler.py.
#include "runtime/servers/conversion.h"

#include <algorithm>
#include <cmath>

#include "runtime/robot/rotation.h"

namespace probe::servers {
namespace {

Failure bad_conversion(std::string message) { return {Fault::kPolicy, std::move(message), ""}; }

bool is_masked(const Statistics& statistics, std::size_t i) {
  return i < statistics.mask.size() && statistics.mask[i] == 0;
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
      return {1, -1};
    case GripperRange::kUnitInverted:
      return {1, 0};
    case GripperRange::kSigned:
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

// Three numbers that are a share of what the robot does in a step, held to it.
void scale(ActionUnits units, double unit, double* numbers) {
  const double size = length(numbers);
  const double shorter = units == ActionUnits::kBall && size > 1 ? 1 / size : 1;
  for (int i = 0; i < 3; ++i) {
    const double share =
        units == ActionUnits::kBox ? std::clamp(numbers[i], -1.0, 1.0) : numbers[i] * shorter;
    numbers[i] = share * unit;
  }
}

// The pose to be at as the change that brings the controller's target there. Its law is T' =
// Trans(p) [R, d] Trans(-p) T with p the measured position, so R = R' R_T^-1 and d = t' - p - R (t
// - p).
void set_change(const Profile& profile, const ArmNow& arm, policy::Action* action) {
  policy::Action& a = *action;
  const Vec3 at(a[0], a[1], a[2]), angles(a[3], a[4], a[5]);
  const Quat wanted = profile.action_rotation == RotationForm::kEuler
                          ? robot::from_rpy(angles)
                          : robot::from_rotation_vector(angles);
  const Quat turn = wanted * arm.target.rotation.conjugate();
  const Vec3& from = arm.tool_measured;
  const Vec3 shift = at - from - turn * (arm.target.position - from);
  const Vec3 vector = robot::to_rotation_vector(turn);
  for (int i = 0; i < 3; ++i) {
    a[static_cast<std::size_t>(i)] = shift[i];
    a[static_cast<std::size_t>(i + 3)] = vector[i];
  }
}

double denormalised(const Statistics& statistics, std::size_t i, double value) {
  if (is_masked(statistics, i)) return value;
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

Result<std::vector<double>> laid_out(const Profile& profile, StateLayout layout,
                                     const policy::Proprioception& measured) {
  Quat rotation = measured.tcp_in_base.rotation;
  if (profile.state_frame == StateFrame::kTopDown) rotation = rotation * top_down().conjugate();
  // One sign of the two, so that equal rotations are equal numbers.
  if (rotation.w() < 0) rotation.coeffs() = -rotation.coeffs();
  std::vector<double> state;
  const bool has_pose =
      layout >= StateLayout::kXyzWxyzOpenness && layout <= StateLayout::kXyzRotvecFingers;
  if (has_pose) append(state, measured.tcp_in_base.position);
  const std::vector<double>& joints = measured.joints;
  const std::size_t fingers = std::min(measured.finger_joints, joints.size());
  const auto first_finger = joints.end() - static_cast<std::ptrdiff_t>(fingers);
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
    case StateLayout::kXyzRotvecFingers:
      append(state, robot::to_rotation_vector(rotation));
      if (fingers == 0)
        return bad_conversion("`state.layout` asks for fingers, the robot has none");
      state.insert(state.end(), first_finger, joints.end());
      break;
    case StateLayout::kJoints:
      state = joints;
      break;
    case StateLayout::kJointsOpenness:
    case StateLayout::kArmJoints:
      if (fingers == 0)
        return bad_conversion("`state.layout` leaves out the fingers, the robot has none");
      state.assign(joints.begin(), first_finger);
      if (layout == StateLayout::kJointsOpenness) state.push_back(measured.openness);
      break;
    case StateLayout::kFingers:
      if (fingers == 0) return bad_conversion("`state.more` asks for fingers, the robot has none");
      state.assign(first_finger, joints.end());
      break;
    case StateLayout::kOpenness:
      state = {measured.openness};
      break;
    case StateLayout::kClosedness:
      state = {1 - measured.openness};
      break;
  }
  return state;
}

}  // namespace

std::string to_prompt(const Profile& profile, std::string_view prompt) {
  std::string text(prompt);
  if (profile.prompt_case == PromptCase::kLower) {
    for (char& c : text) {
      if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    }
  }
  const bool has_stop = text.ends_with('.');
  if (profile.prompt_full_stop == FullStop::kWithout && has_stop) text.pop_back();
  if (profile.prompt_full_stop == FullStop::kWith && !has_stop) text.push_back('.');
  return text;
}

Result<std::vector<double>> to_state(const Profile& profile,
                                     const policy::Proprioception& measured) {
  PROBE_ASSIGN(std::vector<double> state, laid_out(profile, profile.state_layout, measured));
  const Statistics& statistics = profile.state_statistics;
  if (statistics.kind == Normalisation::kNone) return state;
  const std::size_t known =
      statistics.kind == Normalisation::kBound ? statistics.low.size() : statistics.mean.size();
  if (known != state.size()) {
    return bad_conversion("the profile has statistics of " + std::to_string(known) +
                          " numbers, the state has " + std::to_string(state.size()));
  }
  for (std::size_t i = 0; i < state.size(); ++i) state[i] = normalised(statistics, i, state[i]);
  return state;
}

Result<std::vector<double>> to_state(const Profile& profile, StateLayout layout,
                                     const policy::Proprioception& measured) {
  return laid_out(profile, layout, measured);
}

RawAction denormalised(const Profile& profile, const RawAction& raw) {
  RawAction action = raw;
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
  policy::Action action = denormalised(profile, raw);
  const bool is_absolute = profile.action_form == ActionForm::kAbsolute;
  if (is_absolute) set_change(profile, arm, &action);
  PROBE_TRY(check_limit(length(action.data()), profile.action_limit_m, "shifts by", "m",
                        "action.limit_m"));
  PROBE_TRY(check_limit(length(action.data() + 3), profile.action_limit_rad, "turns by", "rad",
                        "action.limit_rad"));
  if (profile.action_rotation == RotationForm::kEuler && !is_absolute) {
    const Vec3 turn = robot::to_rotation_vector(robot::from_rpy({action[3], action[4], action[5]}));
    for (int i = 0; i < 3; ++i) action[static_cast<std::size_t>(i + 3)] = turn[i];
  }
  PROBE_ASSIGN(action[6], to_gripper(profile, action[6]));
  return action;
}

}  // namespace probe::servers
