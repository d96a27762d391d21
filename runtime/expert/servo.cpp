// The inverse of the control law: which action moves the controller's target from the present one
// to the wanted one.
#include "runtime/expert/servo.h"

#include <algorithm>

#include "runtime/base/check.h"
#include "runtime/robot/control.h"
#include "runtime/robot/grip_command.h"
#include "runtime/robot/ik.h"
#include "runtime/robot/rotation.h"

namespace probe::expert {
namespace {

// What the target may move in one action, whatever is asked: larger jumps swing the arm.
constexpr double kLargestShift = 0.10;  // m
constexpr double kLargestTurn = 0.60;   // rad

// Of a law that goes on from where things are measured. In a control step drives come 0.35 to 0.45
// of the way to where their paths end; in steady motion the tool goes a third of what it is asked
// for.
constexpr double kAheadOfGoal = 1.5;                      // times the way that is left
constexpr double kAheadOfPace = 2.5;                      // times the pace
constexpr double kFarthest = 0.20, kFarthestTurn = 0.90;  // m, rad
constexpr double kClosingStep = -0.15;   // of the gripper's number, in a control step
constexpr double kFingersStand = 0.006;  // of openness in a control step: less is standing

constexpr int kBeforeTrust =
    3;  // control steps until the drives are known well enough to doubt the target
constexpr double kBelieved = 0.5;  // of what the target seems to be off

double share(double length, double most) { return length > most ? most / length : 1.0; }

}  // namespace

bool is_near(const Pose& a, const Pose& b, double shift, double turn) {
  const robot::PoseError e = robot::pose_error(a, b);
  return e.position < shift && e.rotation < turn;
}

Pose stepped(const Pose& from, const Pose& to, double shift, double turn) {
  const Vec3 way = to.position - from.position;
  const Vec3 rotation = robot::to_rotation_vector(to.rotation * from.rotation.conjugate());
  return {from.position + way * share(way.norm(), shift),
          (robot::from_rotation_vector(rotation * share(rotation.norm(), turn)) * from.rotation)
              .normalized()};
}

void Servo::begin(const robot::Chain& chain, const Arm& arm, const robot::Law& law, double rate) {
  PROBE_CHECK(arm.joints.size() >= chain.joint_count(), "a position for each joint of the chain");
  chain_ = &chain;
  response_.reset();
  target_ = arm.tcp;
  knows_target_ = false;
  last_shift_ = 0;
  last_openness_ = arm.openness;
  was_closing_ = false;
  learnt_ = 0;
  tracker_.reset();
  from_measured_ = std::holds_alternative<robot::EeDeltaInterpolated>(law);
  if (const auto* osc = std::get_if<robot::OscPose>(&law)) {
    tracker_.emplace(*osc, rate);
    tracker_->begin(arm.tcp);
  }
}

policy::Action Servo::next(const Arm& arm) {
  PROBE_CHECK(tracker_.has_value(), "between decisions there are steps under `osc_pose` alone");
  tracker_->observe(arm.tcp);
  return tracker_->act(arm.openness);
}

policy::Action Servo::aim(const Pose& goal, const Arm& arm, double gripper) {
  tracker_->aim(goal, gripper);
  return tracker_->act(arm.openness);
}

void Servo::observe(const Arm& arm, bool free) {
  const std::size_t n = chain_->joint_count();
  if (tracker_) return tracker_->observe(arm.tcp);
  if (from_measured_) return;
  if (free && knows_target_) {
    response_.learn(std::span(joints_before_).first(n), std::span(joint_target_).first(n),
                    arm.joints.first(n));
    if (++learnt_ > kBeforeTrust) correct_target(arm);
  }
  std::copy_n(arm.joints.begin(), n, joints_before_.begin());
}

// Had the target been what the servo thinks, the joints would stand elsewhere: somebody changed the
// actions on their way (noise does). Half of the difference is believed.
void Servo::correct_target(const Arm& arm) {
  const std::size_t n = chain_->joint_count();
  Joints q = joint_target_;
  for (std::size_t j = 0; j < n; ++j) {
    const double share = 1 / response_.lead(j);
    const double expected = joints_before_[j] + share * (joint_target_[j] - joints_before_[j]);
    q[j] += kBelieved * (arm.joints[j] - expected) / share;
  }
  target_ = chain_->pose(std::span(q).first(n));
}

policy::Action Servo::toward(const Pose& goal, const Arm& arm, double gripper, const Pace& pace) {
  if (from_measured_) return go_to(ahead_of_measured(goal, arm, pace), arm, gripper);
  const double shift = std::min(pace.shift, last_shift_ + pace.gain);
  const Pose next = stepped(arm.tcp, goal, shift, pace.turn);
  last_shift_ = (next.position - arm.tcp.position).norm();
  if (tracker_) return aim(next, arm, gripper);
  return set_target(pace.lead ? ahead_of(next, arm) : next, arm, gripper);
}

policy::Action Servo::settle(const Pose& pose, const Arm& arm, double gripper) {
  last_shift_ = 0;
  if (tracker_) return aim(pose, arm, gripper);
  if (from_measured_) return go_to(pose, arm, gripper);
  return set_target(pose, arm, gripper);
}

policy::Action Servo::hold(const Arm& arm, double gripper) {
  if (tracker_) return aim(tracker_->goal(), arm, gripper);
  if (from_measured_) return go_to(arm.tcp, arm, gripper);
  return {0, 0, 0, 0, 0, 0, gripper};
}

// Where to ask for, so that the tool goes on at a pace and stops at the goal.
Pose Servo::ahead_of_measured(const Pose& goal, const Arm& arm, const Pace& pace) const {
  const Vec3 way = goal.position - arm.tcp.position;
  const Vec3 turn = robot::to_rotation_vector(goal.rotation * arm.tcp.rotation.conjugate());
  const double far = kAheadOfGoal * way.norm(), round = kAheadOfGoal * turn.norm();
  const double shift = kAheadOfGoal * share(far, kAheadOfPace * pace.shift);
  const double by = kAheadOfGoal * share(round, kAheadOfPace * pace.turn);
  return {arm.tcp.position + shift * way,
          (robot::from_rotation_vector(by * turn) * arm.tcp.rotation).normalized()};
}

// The law goes from where the tool is, and its gripper goes on by as much as it is told.
policy::Action Servo::go_to(const Pose& pose, const Arm& arm, double gripper) {
  const Pose next = stepped(arm.tcp, pose, kFarthest, kFarthestTurn);
  const Vec3 shift = next.position - arm.tcp.position;
  const Vec3 turn = robot::to_rotation_vector(next.rotation * arm.tcp.rotation.conjugate());
  const double grip = grip_step(gripper, arm.openness);
  return {shift.x(), shift.y(), shift.z(), turn.x(), turn.y(), turn.z(), grip};
}

// Fingers that come at full speed to what they close on press with their drives' limits, where
// they hold no place and swing with what is between them. Once they stand, the goal that they were
// told last is far enough ahead to hold.
double Servo::grip_step(double gripper, double openness) {
  const double closed_by = last_openness_ - openness;
  last_openness_ = openness;
  const bool closes = gripper <= kClosedGripper;
  const bool stands = closes && was_closing_ && std::abs(closed_by) < kFingersStand;
  was_closing_ = closes;
  if (closes) return stands ? 0 : kClosingStep;
  if (gripper >= kOpenGripper) return gripper;
  return robot::openness_of_command(gripper) - openness;
}

// The pose whose joint positions, as targets, bring the joints to those of `next` within the step.
Pose Servo::ahead_of(const Pose& next, const Arm& arm) const {
  const std::size_t n = chain_->joint_count();
  Joints q{};
  std::copy_n(arm.joints.begin(), n, q.begin());
  if (!robot::solve_ik(*chain_, next, std::span(q).first(n)).converged) return next;
  return ahead_of(std::span(q).first(n), arm);
}

Pose Servo::ahead_of(std::span<const double> next, const Arm& arm) const {
  Joints q{};
  for (std::size_t j = 0; j < next.size(); ++j) {
    const double there = arm.joints[j] + (next[j] - arm.joints[j]) * response_.lead(j);
    q[j] = std::clamp(there, chain_->lower()[j], chain_->upper()[j]);
  }
  return chain_->pose(std::span(q).first(next.size()));
}

policy::Action Servo::follow(std::span<const double> joints, const Arm& arm, double gripper) {
  last_shift_ = (chain_->pose(joints).position - arm.tcp.position).norm();
  if (tracker_) return aim(chain_->pose(joints), arm, gripper);
  if (from_measured_) return go_to(chain_->pose(joints), arm, gripper);
  return set_target(ahead_of(joints, arm), arm, gripper);
}

policy::Action Servo::set_target(const Pose& wanted, const Arm& arm, double gripper) {
  const Pose next = stepped(target_, wanted, kLargestShift, kLargestTurn);
  const Vec3 rotation = robot::to_rotation_vector(next.rotation * target_.rotation.conjugate());
  // The controller turns the target about the measured position; the shift makes up for what that
  // moves.
  const Vec3 swung = arm.tcp.position +
                     robot::from_rotation_vector(rotation) * (target_.position - arm.tcp.position);
  const Vec3 shift = next.position - swung;
  target_ = robot::moved_target(target_, arm.tcp.position, shift, rotation);

  const std::size_t n = chain_->joint_count();
  std::copy_n(arm.joints.begin(), n, joint_target_.begin());
  knows_target_ = robot::solve_ik(*chain_, target_, std::span(joint_target_).first(n)).converged;
  return {shift.x(), shift.y(), shift.z(), rotation.x(), rotation.y(), rotation.z(), gripper};
}

}  // namespace probe::expert
