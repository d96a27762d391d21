// Numbers and order of mani_skill2_real2sim's agents/controllers (pd_ee_pose.py, pd_joint_pos.py)
// and of SAPIEN's inverse kinematics, as the Google robot's setup uses them.
#include "runtime/robot/interpolated.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "runtime/base/check.h"
#include "runtime/base/trig.h"
#include "runtime/robot/action_check.h"
#include "runtime/robot/rotation.h"

namespace probe::robot {
namespace {

using std::size_t;
using Vec6 = Eigen::Matrix<double, 6, 1>;

constexpr double kStep = 0.1, kDamping = 1e-6, kClose = 1e-4;
constexpr int kIterations = 100;
constexpr double kPastLimit = 0.01;  // rad or m: so far a finger's goal may be beyond its limit
constexpr double kNoStep = 1e-3;     // rad or m: less leaves the fingers' goals as they were

// The twist (m, rad; body frame) that leads from the identity to a pose in a unit of time.
Vec6 logarithm(const Pose& pose) {
  const Vec3 w = to_rotation_vector(pose.rotation);
  const double angle = w.norm();
  // (1 - a / (2 tan(a / 2))) / a2, which is 1 / 12 where a is 0.
  double of_square = 1.0 / 12;
  if (angle > 1e-4) {
    const SinCos half = portable_sincos(0.5 * angle);
    of_square = (1 - 0.5 * angle * half.cos / half.sin) / (angle * angle);
  }
  const Vec3& p = pose.position;
  Vec6 out;
  out.head<3>() = p - 0.5 * w.cross(p) + of_square * w.cross(w.cross(p));
  out.tail<3>() = w;
  return out;
}

bool above_zero(const PathLimits& l) {
  return l.speed > 0 && l.acceleration > 0 && l.jerk > 0 && std::isfinite(l.speed) &&
         std::isfinite(l.acceleration) && std::isfinite(l.jerk);
}

// The link right behind the joint of the chain that is nearest to the tool.
std::string last_link(const RobotModel& model, std::string_view tool) {
  int link = model.find_link(tool);
  while (link >= 0) {
    const int above = model.links[static_cast<size_t>(link)].parent_joint;
    if (above < 0 || model.joints[static_cast<size_t>(above)].kind != JointKind::kFixed) break;
    link = model.joints[static_cast<size_t>(above)].parent_link;
  }
  return link < 0 ? std::string(tool) : model.links[static_cast<size_t>(link)].name;
}

}  // namespace

bool approach_pose(const Chain& chain, const Pose& goal, std::span<double> q) {
  std::array<double, kMaxChainJoints> now{};
  std::copy(q.begin(), q.end(), now.begin());
  const auto at = std::span(now).first(q.size());
  Jacobian jacobian;
  for (int i = 0; i < kIterations; ++i) {
    const Pose pose = chain.pose(at, jacobian);
    const Vec6 error = logarithm(pose.inverse() * goal);
    if (error.norm() < kClose) {
      std::copy(at.begin(), at.end(), q.begin());
      return true;
    }
    const Mat3 back = pose.rotation.conjugate().toRotationMatrix();
    const Jacobian turned = jacobian;
    jacobian.topRows<3>() = back * turned.topRows<3>();
    jacobian.bottomRows<3>() = back * turned.bottomRows<3>();
    Eigen::Matrix<double, 6, 6> normal = jacobian * jacobian.transpose();
    normal.diagonal().array() += kDamping;
    const Vec6 weighed = normal.ldlt().solve(error);
    for (size_t j = 0; j < q.size(); ++j)
      now[j] += kStep * jacobian.col(static_cast<Eigen::Index>(j)).dot(weighed);
  }
  return false;
}

Result<InterpolatedController> InterpolatedController::create(const RobotModel& model,
                                                              const EeControlSpec& spec,
                                                              const EeDeltaInterpolated& law) {
  PROBE_ASSIGN(Chain tool, Chain::create(model, spec.tcp_link, spec.arm_joints));
  if (spec.arm_joints.empty()) {
    return Failure{Fault::kUrdf, fmt::format("no joint moves the link `{}`", spec.tcp_link),
                   model.path};
  }
  PROBE_ASSIGN(Chain last, Chain::create(model, last_link(model, spec.tcp_link), spec.arm_joints));
  InterpolatedController made(std::move(tool), std::move(last));
  PROBE_TRY(finger_range(model, spec.finger_joints));
  if (!std::isfinite(spec.grip_closed) || !std::isfinite(spec.grip_open))
    return Failure{Fault::kUrdf, "the gripper's targets are not finite", model.path};
  if (!above_zero(law.arm) || !above_zero(law.fingers) || !(law.period > 0)) {
    return Failure{Fault::kUrdf,
                   "the limits of the paths of `ee_delta_interpolated` are not above 0",
                   model.path};
  }
  made.law_ = law;
  made.grip_closed_ = spec.grip_closed;
  made.grip_open_ = spec.grip_open;
  const size_t arm = spec.arm_joints.size(), all = arm + spec.finger_joints.size();
  const std::vector<double> zero(arm, 0.0);
  made.tip_ = made.last_.pose(zero).inverse() * made.tool_.pose(zero);
  for (const std::string& name : spec.finger_joints) {
    const Joint& joint = model.joints[static_cast<size_t>(model.find_joint(name))];
    made.finger_low_.push_back(joint.lower - kPastLimit);
    made.finger_high_.push_back(joint.upper + kPastLimit);
  }
  made.speeds_.assign(all, 0);
  made.goal_joints_.assign(arm, 0);
  made.path_speeds_.assign(arm, 0);
  made.paths_.assign(all, JerkPath::fastest({}, 0, law.arm));
  made.targets_.assign(all, 0);
  made.finger_goals_.assign(all - arm, 0);
  made.reset(std::vector<double>(all, 0.0));
  return made;
}

void InterpolatedController::reset(std::span<const double> q) {
  PROBE_CHECK(q.size() == targets_.size(), "one position a drive");
  std::copy(q.begin(), q.end(), targets_.begin());
  const size_t arm = tool_.joint_count();
  std::copy(q.begin() + std::ptrdiff_t(arm), q.end(), finger_goals_.begin());
  std::copy_n(q.begin(), arm, goal_joints_.begin());
  std::ranges::fill(path_speeds_, 0);
  std::ranges::fill(speeds_, 0);
  goal_ = tool_.pose(q.first(arm));
  reached_ = fresh_ = true;
}

Status InterpolatedController::begin(const ToolAction& action, std::span<const double> q,
                                     std::span<const double> speeds, int substeps) {
  PROBE_CHECK(q.size() == targets_.size() && speeds.size() == q.size() && substeps > 0,
              "a measured position and speed a drive");
  PROBE_TRY(check_tool_action(action));
  const Vec3 shift = Eigen::Map<const Vec3>(action.data() + kActionShift);
  const Quat turn = from_rotation_vector(Eigen::Map<const Vec3>(action.data() + kActionTurn));
  const size_t arm = tool_.joint_count();
  const Pose now = tool_.pose(q.first(arm));
  goal_ = {now.position + shift, (turn * now.rotation).normalized()};
  plan_arm(q.first(arm), speeds.first(arm));
  plan_fingers(std::clamp(action[kActionGripper], -1.0, 1.0), q.subspan(arm), speeds.subspan(arm));
  fresh_ = false;
  sample_ = law_.period / substeps;
  done_ = 0;
  return {};
}

// From the measured state after a reset, later from the last sample of the path before.
void InterpolatedController::plan_arm(std::span<const double> q, std::span<const double> speeds) {
  std::copy(q.begin(), q.end(), goal_joints_.begin());
  reached_ = approach_pose(last_, goal_ * tip_.inverse(), goal_joints_);
  std::array<PathPoint, kMaxChainJoints> from{};
  for (size_t j = 0; j < q.size(); ++j) {
    from[j] = fresh_ ? PathPoint{q[j], speeds[j]} : PathPoint{targets_[j], path_speeds_[j]};
    from[j].speed = std::clamp(from[j].speed, -law_.arm.speed, law_.arm.speed);
  }
  paths_together(std::span(from).first(q.size()), goal_joints_, law_.arm,
                 std::span(paths_).first(q.size()));
}

// Always from the measured state: while the fingers hold something, what presses them together
// grows from nothing in each control step.
void InterpolatedController::plan_fingers(double command, std::span<const double> q,
                                          std::span<const double> speeds) {
  const size_t arm = tool_.joint_count();
  const double way = command * (grip_open_ - grip_closed_);
  std::vector<PathPoint> from(q.size());
  for (size_t i = 0; i < q.size(); ++i) {
    const double told = fresh_ ? q[i] : targets_[arm + i];
    if (fresh_) finger_goals_[i] = q[i];
    if (std::abs(way) >= kNoStep)
      finger_goals_[i] = std::clamp(told + way, finger_low_[i], finger_high_[i]);
    from[i] = {q[i], std::clamp(speeds[i], -law_.fingers.speed, law_.fingers.speed)};
  }
  paths_together(from, finger_goals_, law_.fingers, std::span(paths_).subspan(arm));
}

void InterpolatedController::next() {
  const double time = ++done_ * sample_;
  const size_t arm = tool_.joint_count();
  for (size_t j = 0; j < paths_.size(); ++j) {
    const PathPoint now = paths_[j].at(time);
    targets_[j] = now.position;
    if (j < arm) {
      path_speeds_[j] = now.speed;
    } else {
      speeds_[j] = now.speed;
    }
  }
}

ControlState InterpolatedController::save() const {
  ControlState state{goal_, targets_, reached_};
  for (const auto* more : {&path_speeds_, &finger_goals_})
    state.joint_targets.insert(state.joint_targets.end(), more->begin(), more->end());
  state.joint_targets.push_back(fresh_ ? 1 : 0);
  return state;
}

Status InterpolatedController::restore(const ControlState& state) {
  const size_t arm = path_speeds_.size(), fingers = finger_goals_.size();
  if (state.joint_targets.size() != 2 * (arm + fingers) + 1) {
    return Failure{Fault::kPolicy,
                   fmt::format("the controller's state has {} numbers, this robot's has {}",
                               state.joint_targets.size(), 2 * (arm + fingers) + 1),
                   ""};
  }
  auto from = state.joint_targets.begin();
  for (auto* to : {&targets_, &path_speeds_, &finger_goals_}) {
    std::copy_n(from, to->size(), to->begin());
    from += std::ptrdiff_t(to->size());
  }
  fresh_ = *from != 0;
  goal_ = state.target;
  reached_ = state.reached;
  return {};
}

}  // namespace probe::robot
