#include "runtime/expert/put_under.h"

#include <algorithm>
#include <cmath>

#include "runtime/expert/free_way.h"
#include "runtime/robot/grip_command.h"

namespace probe::expert {
namespace {

constexpr int kUnderMostTries = 3;
constexpr double kHoldNear = 0.004, kPutNear = 0.008, kHomeNear = 0.03;  // m
constexpr double kBeforeHold = 0.010, kBeforePut = 0.015;                // m
constexpr double kSlipped = 0.025;   // m that the source may move in the hand
constexpr double kOffPlace = 0.05;   // m, of what was put
constexpr int kLongestLower = 8;     // decisions
constexpr double kDown = 0.006;      // m a decision, until it stands

constexpr Pace kUnderFarPace{.shift = 0.070, .turn = 0.40, .gain = 0.035};
constexpr Pace kUnderNearPace{.shift = 0.035, .turn = 0.20};
constexpr Pace kUnderHeldPace{.shift = 0.060, .turn = 0.30, .gain = 0.025};

bool all_of_them_touch(const Scene& s) {
  return !s.fingers_on_source.empty() &&
         std::ranges::all_of(s.fingers_on_source, [](bool touches) { return touches; });
}

}  // namespace

bool PutUnder::begin(const Scene& scene, const policy::Privileged& view, const policy::Skill& skill,
                     const Reach& reach, const Pose& ready, bool only_reaches) {
  *this = {};
  only_reaches_ = only_reaches;
  skill_ = skill;
  ready_ = ready;
  return plan(scene, view, reach);
}

bool PutUnder::plan(const Scene& scene, const policy::Privileged& view, const Reach& reach) {
  const bool lifts = skill_.kind == policy::Skill::Kind::kPick || only_reaches_;
  std::vector<PutPlace> places;
  if (!lifts) places = find_put_places(scene, view, skill_);
  plan_ = plan_put({&scene, &view, &reach, skill_.object, places, failed_, lifts});
  if (!plan_) return false;
  enter(plan_->sets_first ? Phase::kSet : Phase::kGo);
  way_.begin(plan_->to_hold, kHoldNear, kBeforeHold);
  return true;
}

void PutUnder::enter(Phase phase) {
  phase_ = phase;
  steps_ = 0;
}

void PutUnder::start_over(const Scene& scene, const policy::Privileged& view, const Reach& reach,
                          const char* lack) {
  lack_ = lack;
  failed_.push_back(plan_->hold);
  if (++tries_ >= kUnderMostTries || !plan(scene, view, reach)) enter(Phase::kOver);
}

bool PutUnder::holds(const Scene& s) const {
  const Vec3 now = s.tcp.inverse().apply(s.source_pose.position);
  return (now - taken_.position).norm() < kSlipped;
}

void PutUnder::begin_leave(const Scene& scene, const policy::Privileged& view, const Reach& reach) {
  std::vector<Pose> way = plan_->leave;
  const robot::HandShape& hand = reach.hand().shape;
  // As open as they are by now, and as they are told to be.
  std::vector<Ball> balls = hand_balls(hand, hand.gap_at(scene.openness)).all();
  const std::vector<Ball> told = hand_balls(hand, hand.gap_at(plan_->open)).all();
  balls.insert(balls.end(), told.begin(), told.end());
  if (const auto home = free_way(surroundings_of(view), way.back(), ready_, balls))
    way.insert(way.end(), home->begin(), home->end());
  way_.begin(std::move(way), kHomeNear, kHomeNear);
  enter(Phase::kLeave);
}

void PutUnder::advance(const Scene& s, const policy::Privileged& view, const Reach& reach) {
  switch (phase_) {
    case Phase::kSet:
      if (are_set(s.openness, plan_->open, steps_)) enter(Phase::kGo);
      return;
    case Phase::kGo:
      switch (way_.advance(s.tcp)) {
        case ToolWay::State::kGoing:
          return;
        case ToolWay::State::kThere:
          return enter(only_reaches_ ? Phase::kKeep : Phase::kGrip);
        case ToolWay::State::kStuck:
          return start_over(s, view, reach, "the hand does not come to its hold");
      }
      return;
    case Phase::kGrip:
      if (steps_ < 2) return;
      if (all_of_them_touch(s)) {
        taken_ = s.tcp.inverse() * s.source_pose;
        way_.begin(plan_->carry, kPutNear, kBeforePut);
        return enter(Phase::kCarry);
      }
      if (steps_ >= 4) start_over(s, view, reach, "not all fingers touch it when they close");
      return;
    case Phase::kCarry:
      if (!holds(s)) return start_over(s, view, reach, "it slipped in the hand");
      if (way_.advance(s.tcp) == ToolWay::State::kGoing) return;
      return enter(plan_->leave.empty() ? Phase::kKeep : Phase::kLower);
    case Phase::kKeep:
      if (!only_reaches_ && !holds(s)) start_over(s, view, reach, "it slipped in the hand");
      return;
    case Phase::kLower: {
      const bool stopped = steps_ >= 3 && last_.position.z() - s.tcp.position.z() < 0.0008;
      if (stopped || steps_ >= kLongestLower) enter(Phase::kOpen);
      return;
    }
    case Phase::kOpen:
      if (steps_ >= 4) begin_leave(s, view, reach);
      return;
    case Phase::kLeave:
      if (way_.advance(s.tcp) == ToolWay::State::kGoing) return;
      is_done_ = (s.source_pose.position - plan_->put.position).norm() < kOffPlace;
      if (is_done_) return enter(Phase::kOver);
      return start_over(s, view, reach, "it does not lie where it was put");
    case Phase::kOver:
      return;
  }
}

policy::Action PutUnder::command(const Scene& s, Servo& servo) const {
  const Arm arm{s.tcp, s.joints, s.openness};
  const double open = robot::command_of_openness(plan_->open);
  switch (phase_) {
    case Phase::kSet:
      return servo.hold(arm, open);
    case Phase::kGo:
      return servo.toward(way_.goal(), arm, open, way_.is_last() ? kUnderNearPace : kUnderFarPace);
    case Phase::kGrip:
      return servo.settle(plan_->to_hold.back(), arm, kClosedGripper);
    case Phase::kCarry:
      return servo.toward(way_.goal(), arm, kClosedGripper,
                          way_.is_last() ? kUnderNearPace : kUnderHeldPace);
    case Phase::kKeep:
      return servo.hold(arm, only_reaches_ ? open : kClosedGripper);
    case Phase::kLower: {
      Pose goal = plan_->carry.back();
      goal.position.z() = std::min(goal.position.z(), s.tcp.position.z()) - kDown;
      return servo.toward(goal, arm, kClosedGripper, kUnderNearPace);
    }
    case Phase::kOpen:
      return servo.settle(s.tcp, arm, open);
    case Phase::kLeave:
      return servo.toward(way_.goal(), arm, open, kUnderFarPace);
    case Phase::kOver:
      break;
  }
  return servo.hold(arm, kOpenGripper);
}

std::optional<policy::Action> PutUnder::act(const Scene& scene, const policy::Privileged& view,
                                            const Reach& reach, Servo& servo) {
  // Phases that are done take no time; each leads on, so this ends.
  for (int i = 0; i < 8; ++i) {
    const Phase before = phase_;
    const int tries = tries_;
    advance(scene, view, reach);
    if (phase_ == before && tries == tries_) break;
  }
  ++steps_;
  last_ = scene.tcp;
  if (phase_ == Phase::kOver) {
    if (is_done_) lack_.clear();
    return std::nullopt;
  }
  return command(scene, servo);
}

}  // namespace probe::expert
