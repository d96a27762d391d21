// Formulas and their order are those of robosuite 1.4.1's controllers/osc.py and
// utils/control_utils.py; its pseudo-inverses are solved for, not formed.
#include "runtime/robot/osc.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <Eigen/Eigenvalues>

#include "runtime/base/check.h"
#include "runtime/robot/action_check.h"
#include "runtime/robot/rotation.h"

namespace probe::robot {
namespace {

std::string_view wanted_share(std::size_t number, std::size_t /*size*/) {
  if (number < kActionTurn) return "a share of the largest shift, -1 to 1";
  return number < kActionGripper ? "a share of the largest turn, -1 to 1"
                                 : "the gripper, -1 opens, 1 closes";
}

using Eigen::Index;
using std::size_t;

// Where a solution by Cholesky is none any more: a pivot's share of the largest diagonal entry.
constexpr double kThinPivot = 1e-12;
// numpy's pinv with robosuite's rcond: singular values below this share of the largest count as 0.
constexpr double kNoDirection = 1e-15;

template <int N>
using Square = Eigen::Matrix<double, N, N>;
template <int N>
using Column = Eigen::Matrix<double, N, 1>;

// pinv(a) b of a symmetric matrix that has no negative direction.
template <int N>
Column<N> solve_by_directions(const Square<N>& a, const Column<N>& b) {
  const Eigen::SelfAdjointEigenSolver<Square<N>> of(a);
  Column<N> x = Column<N>::Zero();
  for (int i = 0; i < N; ++i) {
    const double stretch = of.eigenvalues()[i];
    if (!(stretch > kNoDirection * of.eigenvalues()[N - 1])) continue;
    x += of.eigenvectors().col(i) * (of.eigenvectors().col(i).dot(b) / stretch);
  }
  return x;
}

template <int N>
Column<N> solve(const Square<N>& a, const Column<N>& b) {
  Square<N> l = a;
  const double least = kThinPivot * a.diagonal().maxCoeff();
  Column<N> x = b;
  for (int j = 0; j < N; ++j) {
    for (int k = 0; k < j; ++k) {
      for (int i = j; i < N; ++i) l(i, j) -= l(i, k) * l(j, k);
    }
    if (!(l(j, j) > least)) return solve_by_directions<N>(a, b);
    const double root = std::sqrt(l(j, j));
    for (int i = j; i < N; ++i) l(i, j) /= root;
    x[j] /= l(j, j);
    for (int i = j + 1; i < N; ++i) x[i] -= l(i, j) * x[j];
  }
  for (int j = N; j-- > 0;) {
    for (int i = j + 1; i < N; ++i) x[j] -= l(i, j) * x[i];
    x[j] /= l(j, j);
  }
  return x;
}

// J M^-1 J^T = X^T X with L X = J^T, M = L L^T: what a wrench at the tool does to its motion, 1/kg
// and so on. False where M is no mass matrix.
bool mobility(const MassMatrix& mass, const Jacobian& jacobian, Square<6>* out) {
  const Index n = mass.rows();
  MassMatrix l = mass;
  Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::ColMajor, 6, kMaxChainJoints> x = jacobian;
  for (Index j = 0; j < n; ++j) {
    for (Index k = 0; k < j; ++k) {
      for (Index i = j; i < n; ++i) l(i, j) -= l(i, k) * l(j, k);
    }
    if (!(l(j, j) > 0)) return false;
    const double root = std::sqrt(l(j, j));
    for (Index i = j; i < n; ++i) l(i, j) /= root;
    for (Index k = 0; k < j; ++k) x.col(j) -= l(j, k) * x.col(k);
    x.col(j) /= l(j, j);
  }
  out->setZero();
  for (Index j = 0; j < n; ++j) {
    for (int b = 0; b < 6; ++b) {
      for (int a = 0; a < 6; ++a) (*out)(a, b) += x(a, j) * x(b, j);
    }
  }
  return true;
}

Failure refuse(const RobotModel& model, std::string message) {
  return {Fault::kUrdf, std::move(message), model.path};
}

Status check_law(const RobotModel& model, const EeControlSpec& spec, const OscPose& law) {
  for (size_t i = 0; i < 6; ++i) {
    if (!(law.kp[i] >= 0) || !(law.damping[i] >= 0) || !(law.output[i] >= 0) ||
        !std::isfinite(law.kp[i] + law.damping[i] + law.output[i])) {
      return refuse(model,
                    "`osc_pose` has a stiffness, damping or output that is negative or not "
                    "finite");
    }
  }
  if (!(law.null_kp >= 0) || !std::isfinite(law.null_kp) || !(law.ramp >= 0) || !(law.ramp <= 1)) {
    return refuse(model,
                  "`osc_pose` has a stiffness of the null space that is negative, or a ramp "
                  "that is not between 0 and 1");
  }
  if (!(law.grip.pace >= 0) || !(law.grip.stiffness >= 0) || !(law.grip.limit >= 0) ||
      !std::isfinite(law.grip.pace + law.grip.stiffness + law.grip.limit)) {
    return refuse(model, "the gripper of `osc_pose` has a negative or non-finite number");
  }
  if (law.home.size() != spec.arm_joints.size()) {
    return refuse(model, fmt::format("`osc_pose` has {} home positions for {} arm joints",
                                     law.home.size(), spec.arm_joints.size()));
  }
  for (const double q : law.home) {
    if (!std::isfinite(q)) return refuse(model, "a home position of `osc_pose` is not finite");
  }
  return {};
}

}  // namespace

ToolAction shares_of(const OscPose& law, const ToolAction& action) {
  ToolAction shares = action;
  for (size_t i = 0; i < law.output.size(); ++i) shares[i] /= law.output[i];
  shares[kActionGripper] = -action[kActionGripper];
  return shares;
}

Vec3 rotation_error(const Mat3& from, const Mat3& to) {
  return 0.5 * (from.col(0).cross(to.col(0)) + from.col(1).cross(to.col(1)) +
                from.col(2).cross(to.col(2)));
}

Result<OscPoseController> OscPoseController::create(const RobotModel& model,
                                                    const EeControlSpec& spec, OscPose law) {
  PROBE_TRY(check_law(model, spec, law));
  PROBE_ASSIGN(const Chain chain, Chain::create(model, spec.tcp_link, spec.arm_joints));
  if (spec.arm_joints.empty()) {
    return refuse(model, fmt::format("no joint moves the link `{}`", spec.tcp_link));
  }
  if (spec.arm_joints.size() + spec.finger_joints.size() > size_t(kMaxChainJoints)) {
    return refuse(model, fmt::format("`osc_pose` drives at most {} joints, arm and fingers",
                                     kMaxChainJoints));
  }
  OscPoseController made;
  made.arm_ = spec.arm_joints.size();
  made.home_ = chain.pose(law.home);
  if (!law.limits.empty() && law.limits.size() != spec.arm_joints.size()) {
    return refuse(model, fmt::format("`osc_pose` has {} limits for {} arm joints",
                                     law.limits.size(), spec.arm_joints.size()));
  }
  for (const std::string& name : spec.arm_joints) {
    const double effort = law.limits.empty() ? model.joints[size_t(model.find_joint(name))].effort
                                             : law.limits[made.limits_.size()];
    if (!(effort > 0)) {
      return refuse(model, fmt::format("joint `{}` needs an effort above 0: `osc_pose` clips its "
                                       "torque to it",
                                       name));
    }
    made.limits_.push_back(effort);
  }
  PROBE_TRY(finger_range(model, spec.finger_joints));
  for (size_t i = 0; i < spec.finger_joints.size(); ++i) {
    made.fingers_.push_back(
        {0.5 * (spec.grip_closed + spec.grip_open), 0.5 * (spec.grip_open - spec.grip_closed)});
  }
  for (size_t i = 0; i < 6; ++i) made.kd_[i] = 2 * std::sqrt(law.kp[i]) * law.damping[i];
  made.law_ = std::move(law);
  made.reset();
  return made;
}

void OscPoseController::reset() {
  goal_ = start_ = home_;
  opening_ = 0;
  delta_ = {};
  grip_ = 0;
  pending_ = false;
  fresh_ = true;
  ramp_ = ramped_ = 0;
}

Status OscPoseController::begin(std::span<const double> action, int substeps) {
  PROBE_CHECK(action.size() == kActionSize, "six shares and a gripper");
  PROBE_TRY(check_numbers(action, wanted_share));
  for (size_t i = 0; i < 6; ++i) delta_[i] = std::clamp(action[i], -1.0, 1.0) * law_.output[i];
  const double grip = action[kActionGripper];
  grip_ = grip > 0 ? 1 : grip < 0 ? -1 : 0;
  pending_ = true;
  ramped_ = 0;
  ramp_ = static_cast<int>(std::ceil(law_.ramp * substeps));
  return {};
}

// The shift begins where the tool is, not where it was meant to be. So does the turn; but without
// one the last rotation that was asked for stays asked for.
void OscPoseController::set_goal(const Dynamics& now) {
  start_ = goal_;
  goal_.position = now.position + Eigen::Map<const Vec3>(delta_.data());
  const Vec3 turn = Eigen::Map<const Vec3>(delta_.data() + 3);
  if (turn != Vec3::Zero()) {
    goal_.rotation = (from_rotation_vector(turn) * Quat(now.axes)).normalized();
  }
  pending_ = false;
}

// With a ramp robosuite's LinearInterpolator: each substep goes the same way from the last goal,
// divided by the substeps left.
Pose OscPoseController::wanted() {
  if (ramp_ <= 1) return goal_;
  const double left = ramp_ - ramped_;
  const Vec3 turn = to_rotation_vector(goal_.rotation * start_.rotation.conjugate());
  const double turned = double(ramped_ + 1) / ramp_;
  if (ramped_ < ramp_ - 1) ++ramped_;
  return {start_.position + (goal_.position - start_.position) / left,
          (from_rotation_vector(turn * turned) * start_.rotation).normalized()};
}

void OscPoseController::efforts(const Dynamics& now, std::span<double> out) {
  PROBE_CHECK(out.size() == joint_count() && size_t(now.q.size()) == arm_, "an effort a joint");
  if (pending_) set_goal(now);
  fresh_ = false;
  arm_efforts(now, wanted(), out.first(arm_));
  // The command moves in every substep; 0 keeps it.
  opening_ = std::clamp(opening_ - law_.grip.pace * grip_, -1.0, 1.0);
  for (size_t i = 0; i < fingers_.size(); ++i) {
    const double asked = fingers_[i].middle + fingers_[i].half * opening_;
    out[arm_ + i] = std::clamp(law_.grip.stiffness * (asked - now.all_q[arm_ + i]),
                               -law_.grip.limit, law_.grip.limit);
  }
}

// tau = J^T wrench + bias + null, with A = J M^-1 J^T, of which p and r are the blocks of shift and
// turn:
//   wrench = (A_p^-1 F, A_r^-1 T), or A^-1 (F, T) where both are coupled,
//   null = N^T M x = M x - J^T A^-1 J x,  N = 1 - M^-1 J^T A^-1 J,  x the wish of the joints.
void OscPoseController::arm_efforts(const Dynamics& now, const Pose& goal,
                                    std::span<double> out) const {
  const Mat3 goal_axes = goal.rotation.toRotationMatrix();
  const Vec3 away = goal.position - now.position, turned = rotation_error(now.axes, goal_axes);
  Column<6> wish;  // m/s2, rad/s2
  for (Index i = 0; i < 3; ++i) {
    const size_t p = size_t(i), r = p + 3;
    wish[i] = law_.kp[p] * away[i] - kd_[p] * now.velocity[i];
    wish[i + 3] = law_.kp[r] * turned[i] - kd_[r] * now.spin[i];
  }
  const Index n = Index(arm_);
  JointVector tau = now.bias;
  Square<6> a;
  if (mobility(now.mass, now.jacobian, &a)) {
    JointVector x(n);  // rad/s2
    const double null_kd = 2 * std::sqrt(law_.null_kp);
    for (Index j = 0; j < n; ++j) {
      x[j] = law_.null_kp * (law_.home[size_t(j)] - now.q[j]) - null_kd * now.u[j];
    }
    Column<6> felt = Column<6>::Zero();  // J x
    for (Index j = 0; j < n; ++j) felt += now.jacobian.col(j) * x[j];
    Column<6> wrench = -solve<6>(a, felt);
    if (law_.uncouple) {
      wrench.head<3>() += solve<3>(a.topLeftCorner<3, 3>(), wish.head<3>());
      wrench.tail<3>() += solve<3>(a.bottomRightCorner<3, 3>(), wish.tail<3>());
    } else {
      wrench += solve<6>(a, wish);
    }
    for (Index j = 0; j < n; ++j) {
      double sum = now.jacobian.col(j).dot(wrench);
      for (Index k = 0; k < n; ++k) sum += now.mass(j, k) * x[k];
      tau[j] += sum;
    }
  }
  for (size_t j = 0; j < arm_; ++j) {
    out[j] = std::clamp(tau[Index(j)], -limits_[j], limits_[j]);
  }
}

Status OscPoseController::restore(const ControlState& state) {
  const bool fresh = state.joint_targets.size() == 2 && state.joint_targets[1] != 0;
  if (state.joint_targets.size() != 2 || !(std::abs(state.joint_targets[0]) <= 1) ||
      !is_finite(state.target) || !(std::abs(state.target.rotation.norm() - 1) < 1e-6)) {
    return Failure{Fault::kPolicy, "the controller's state is of another law than `osc_pose`", ""};
  }
  reset();
  fresh_ = fresh;
  goal_ = start_ = state.target;
  opening_ = state.joint_targets[0];
  return {};
}

}  // namespace probe::robot
