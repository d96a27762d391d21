#include "runtime/expert/tool_tracker.h"

#include <algorithm>
#include <cmath>

#include "runtime/robot/rotation.h"

namespace probe::expert {
namespace {

constexpr double kDecisions = 5;  // a second, where the arm is fast enough
// The fastest step of a usual move between two decisions (path_planner's means, 1.9 times: the
// middle of a smooth path).
constexpr double kFastShift = 1.9 * 0.040;  // m
constexpr double kFastTurn = 1.9 * 0.24;    // rad
constexpr double kAsWide = 0.04;            // of openness: close enough
constexpr double kTooWide = 0.08;           // of openness, at rest: to be mended
constexpr double kNearWide = 0.25;          // of openness
constexpr double kRests = 0.004;            // of openness in a control step
constexpr int kParts = 200;                 // of a control step, to follow the law's motion
// Of what the tool is off its way, what a free tool takes back in a control step. All of it at once
// makes the arm swing: a pull at the tool also turns it, and a turn pulls, so that some motions
// answer nearly twice as much as a free tool's and others a ninth of it.
constexpr double kTakenBack = 0.25;
constexpr double kStill = 1e-6;    // of the goal's way in a control step: none
constexpr double kLongest = 1000;  // control steps between decisions

Vec3 part(const std::array<double, 6>& six, std::size_t first) {
  return {six[first], six[first + 1], six[first + 2]};
}

std::array<double, 6> between(const Pose& from, const Pose& to) {
  const Vec3 way = to.position - from.position;
  const Vec3 turn = robot::to_rotation_vector(to.rotation * from.rotation.conjugate());
  return {way.x(), way.y(), way.z(), turn.x(), turn.y(), turn.z()};
}

}  // namespace

// x'' = kp (goal - x) - kd x', kd = 2 sqrt(kp) damping, over one control step; by backward steps,
// which no gain upsets.
ToolTracker::ToolTracker(const robot::OscPose& law, double rate) : output_(law.output) {
  double shift = 1e9, turn = 1e9;  // m and rad in a steady control step
  for (std::size_t i = 0; i < 6; ++i) {
    const double kd = 2 * std::sqrt(law.kp[i]) * law.damping[i], h = 1 / rate / kParts;
    // From rest at 0 with the goal at 1; from 0 with a speed of 1 and the goal at 0.
    const auto follow = [&](double goal, double speed, double* way, double* end) {
      double x = 0, v = speed;
      for (int k = 0; k < kParts; ++k) {
        v = (v + h * law.kp[i] * (goal - x)) / (1 + h * kd + h * h * law.kp[i]);
        x += h * v;
      }
      *way = x;
      *end = v;
    };
    double way_of_goal = 0, speed_of_goal = 0, way_of_speed = 0, speed_of_speed = 0;
    follow(1, 0, &way_of_goal, &speed_of_goal);
    follow(0, 1, &way_of_speed, &speed_of_speed);
    const double kept = std::min(speed_of_speed, 0.95);
    const double steady = way_of_goal + way_of_speed * speed_of_goal / (1 - kept);
    if (!(way_of_goal > kStill && steady > kStill)) continue;  // nothing pulls that way
    responses_[i] = {1 / steady, kTakenBack / way_of_goal};
    double& least = i < 3 ? shift : turn;
    least = std::min(least, steady * law.output[i]);
  }
  const double slow = std::max(kFastShift / shift, kFastTurn / turn);
  const double steps = std::max(rate / kDecisions, slow);
  interval_ = static_cast<int>(std::clamp(std::ceil(steps - 1e-9), 1.0, kLongest));
}

void ToolTracker::begin(const Pose& tool) {
  at_ = from_ = to_ = tool;
  gripper_ = last_openness_ = 1;
  is_wide_ = false;
  step_ = 0;
}

void ToolTracker::aim(const Pose& goal, double gripper) {
  from_ = at_;
  to_ = goal;
  is_wide_ = is_wide_ && gripper == gripper_;
  gripper_ = gripper;
  step_ = 0;
}

policy::Action ToolTracker::act(double openness) {
  const std::array<double, 6> whole = between(from_, to_);
  // Where the tool was to be by now, and from there the way of this step.
  const double share = static_cast<double>(std::min(step_, interval_)) / interval_;
  const bool arrived = step_ >= interval_;
  const Pose meant{
      from_.position + share * part(whole, 0),
      (robot::from_rotation_vector(share * part(whole, 3)) * from_.rotation).normalized()};
  ++step_;
  const std::array<double, 6> off = between(at_, meant);
  robot::ToolAction action{};
  // Shortened as one where it is too much, so that the tool stays on its line.
  std::array<double, 2> most{1, 1};
  for (std::size_t i = 0; i < 6; ++i) {
    const double step = arrived ? 0 : whole[i] / interval_;
    action[i] = responses_[i].of_way * step + responses_[i].of_error * off[i];
    most[i / 3] = std::max(most[i / 3], std::abs(action[i]) / output_[i]);
  }
  for (std::size_t i = 0; i < 6; ++i) action[i] /= most[i / 3];
  action[robot::kActionGripper] = grip(openness);
  return action;
}

// 1 opens, -1 closes, 0 stays: at a fixed pace, which fingers follow a step late. What is as wide
// as it can be told to be is left alone.
double ToolTracker::grip(double openness) {
  const double late = openness - last_openness_;
  last_openness_ = openness;
  if (std::abs(gripper_) >= 1) return gripper_ > 0 ? 1 : -1;
  const double wider = 0.5 * (gripper_ + 1) - openness;
  if (is_wide_) {
    const bool rests = std::abs(late) < kRests;
    is_wide_ = std::abs(wider) < (rests ? kTooWide : 2 * kTooWide);
    if (is_wide_) return 0;
  }
  const bool rests = std::abs(late) < kRests;
  is_wide_ =
      std::abs(wider) < (rests ? kTooWide : kAsWide) || (late != 0 && wider * (wider - late) <= 0);
  // Near by it is told one step at a time, and looked at once that has been done: what is told
  // while it still moves takes it too far, again and again.
  const bool waits = std::abs(wider) < kNearWide && !rests;
  return is_wide_ || waits ? 0 : wider > 0 ? 1 : -1;
}

}  // namespace probe::expert
