#include "runtime/expert/joint_skill.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "runtime/expert/free_way.h"
#include "runtime/robot/grip_command.h"

namespace probe::expert {
namespace {

constexpr int kMostHoldTries = 4, kMostParts = 8, kMostHomes = 2;
constexpr std::size_t kMostHolds = 40;  // put to inverse kinematics
struct OpenShares {
  double aim, enough, least;  // of the way
};
constexpr OpenShares kOpen{0.97, 0.93, 0.85}, kFullyOpen{1, 0.99, 0.96};
constexpr double kClosedEnough = 0.01, kClosedLeast = 0.03;  // of the way
constexpr double kBeyond = 0.03, kTurnSlack = 0.01;          // rad, of a turn
constexpr double kPressEnough = 0.9, kPressLeast = 0.6;      // of the way
constexpr double kFromAbove = 0.9;                           // cosine of 26 degrees
constexpr double kBefore = 0.09;      // m from the hold, where the hand comes from
constexpr double kBeforeEdge = 0.12;  // the same of a hand that reaches over an edge
constexpr double kOverEdge = 0.008;   // m that fingertips are above it first
constexpr double kOff = 0.015;        // m off a face before it is pushed
constexpr double kAhead = 0.040;      // m (of the arc) that the tool is led ahead of the part
constexpr double kMostAhead = 0.35;   // rad
constexpr std::array kShares = {1.0, 0.6, 0.3};  // of the way that is left
constexpr std::array kEdgeShares = {0.6, 0.3};   // the same of what is drawn by its edge
constexpr double kEdgeLeast = 0.5;               // of the whole way: as much of that will do
constexpr double kProgress = 0.1;                // of the way that is left: more is no failure
constexpr double kPress = 0.02;                  // m that a push aims behind the face...
constexpr double kPressLever = 0.5;              // ...but no more of its lever: it slides off else
constexpr int kSamples = 6;                      // of the part's way, for inverse kinematics
constexpr double kStands = 0.0015;               // m in a decision: less is standing still
constexpr double kSticks = 0.002;                // m of arc in a decision: less is no progress
constexpr int kPatience = 5;                     // decisions without progress
constexpr int kLongestMove = 60;

constexpr Pace kFarPace{.shift = 0.070, .turn = 0.40, .gain = 0.035};
constexpr Pace kNearHold{.shift = 0.035, .turn = 0.20};
constexpr Pace kMovePace{.shift = 0.045, .turn = 0.30};
constexpr Pace kTurnPace{.shift = 0.015, .turn = 0.30};

// How far a point of the part goes for a rad; 1 for what slides.
double lever_of(const Hold& hold, const PartJoint& joint) {
  if (joint.slides) return 1;
  const Vec3 off = (hold.pushes() ? hold.contact : hold.tool.position) - joint.point;
  return std::max(0.01, (off - joint.axis.dot(off) * joint.axis).norm());
}

bool is_same(const Hold& a, const Hold& b) {
  return a.follows == b.follows && is_near(a.tool, b.tool, 0.008, 0.3);
}

}  // namespace

namespace {

// Where a joint is open to its end.
double far_of(const PartJoint& joint) {
  return joint.closed == joint.upper ? joint.lower : joint.upper;
}

}  // namespace

JointSkill::Goal JointSkill::goal_of(const policy::Skill& skill, const PartJoint& joint) {
  using Kind = policy::Skill::Kind;
  const double way = far_of(joint) - joint.closed;  // signed
  Goal goal;
  if (skill.kind == Kind::kOpen) {
    const OpenShares shares = skill.fully ? kFullyOpen : kOpen;
    goal = {joint.closed + shares.aim * way, joint.closed + shares.enough * way,
            joint.closed + shares.least * way, way > 0};
  } else if (skill.kind == Kind::kClose) {
    goal = {joint.closed, joint.closed + kClosedEnough * way, joint.closed + kClosedLeast * way,
            way < 0};
  } else if (skill.kind == Kind::kTurn) {
    const double sign = joint.endless || way > 0 ? 1 : -1;
    const double to =
        skill.by ? joint.position + sign * skill.amount : joint.closed + sign * skill.amount;
    goal.up = to >= joint.position;
    const double dir = goal.up ? 1 : -1;
    goal.aim = to + dir * kBeyond;
    if (!joint.endless) goal.aim = std::clamp(goal.aim, joint.lower, joint.upper);
    goal.enough = to + (goal.aim == to ? -dir * 0.5 * kTurnSlack : dir * 0.2 * kTurnSlack);
    goal.least = to - dir * kTurnSlack;
  } else {  // press: to the end that is farther from where it began
    const bool up = joint.upper - joint.rest > joint.rest - joint.lower;
    const double end = joint.endless ? joint.position + 0.5 : up ? joint.upper : joint.lower;
    const double from = joint.endless ? joint.position : joint.rest;
    goal = {end, from + kPressEnough * (end - from), from + kPressLeast * (end - from), end > from};
  }
  return goal;
}

void JointSkill::begin(const policy::Skill& skill, const Pose& ready, bool only_reaches) {
  skill_ = skill;
  ready_ = ready;
  only_reaches_ = only_reaches;
  tries_ = parts_ = homes_ = 0;
  reached_ = planned_ = false;
  failed_.clear();
  lack_.clear();
  hold_.reset();
  enter(Phase::kPlan);
}

void JointSkill::enter(Phase phase) {
  phase_ = phase;
  steps_ = still_ = 0;
  next_ = 0;
}

const policy::PrivilegedFixture& JointSkill::part(const policy::Privileged& view) const {
  return view.fixtures[static_cast<std::size_t>(skill_.fixture)];
}

HoldProblem JointSkill::problem_of(const policy::Privileged& view, const Surroundings& around,
                                   const Arm& arm, const Reach& reach) const {
  HoldProblem problem;
  problem.around = &around;
  problem.fixture = skill_.fixture;
  problem.joint = *part(view).joint;
  problem.aim = aim_;
  problem.now = arm.tcp.rotation;
  problem.grasps = skill_.kind == policy::Skill::Kind::kOpen;
  problem.hand = reach.hand().shape;
  return problem;
}

// Before the last leg: the gripper's width is what its law could make of it.
void JointSkill::refine(const policy::Privileged& view, const Arm& arm, const Reach& reach) {
  const Surroundings around = surroundings_of(view);
  hold_ = refined(problem_of(view, around, arm, reach), *hold_, arm.openness);
  const Pose pose = view.base.inverse() * part(view).pose;
  way_.back() = tool_at(*hold_, pose, reach.hand().shape, hold_->pushes() ? kOff : 0);
}

// All of the way with one hold, or as much as goes: a door is pulled ajar, then pushed from behind.
bool JointSkill::plan(const policy::Privileged& view, const Arm& arm, const Reach& reach) {
  begun_ = part(view).joint->position;
  HoldLack lack;
  for (const double share : kShares) {
    lack = {};
    if (plan(view, arm, reach, begun_ + share * (goal_.aim - begun_), false, &lack)) return true;
  }
  // What has nothing to hold may have an edge.
  HoldLack of_hooks;
  for (const double share : kEdgeShares) {
    if (skill_.kind != policy::Skill::Kind::kOpen) break;
    if (plan(view, arm, reach, begun_ + share * (goal_.aim - begun_), true, &of_hooks)) return true;
  }
  const Surroundings around = surroundings_of(view);
  lack_ = to_text(lack, problem_of(view, around, arm, reach));
  return false;
}

bool JointSkill::plan(const policy::Privileged& view, const Arm& arm, const Reach& reach,
                      double aim, bool hooks, HoldLack* lack) {
  aim_ = aim;
  const Surroundings around = surroundings_of(view);
  const policy::PrivilegedFixture& seen = part(view);
  const Pose pose = view.base.inverse() * seen.pose;
  HoldProblem problem = problem_of(view, around, arm, reach);
  problem.hooks = hooks;
  std::vector<Hold> holds = hold_candidates(problem);
  std::stable_partition(holds.begin(), holds.end(), [&](const Hold& hold) {
    return std::ranges::none_of(failed_, [&](const Hold& old) { return is_same(old, hold); });
  });
  bool is_found = false;
  for (std::size_t i = 0; i < std::min(holds.size(), kMostHolds); ++i) {
    const Hold& hold = holds[i];
    // With one in hand, only for a grip that is better to come back from.
    if (is_found && hold.pushes()) continue;
    ++lack->holds;
    const Pose at = tool_at(hold, pose, problem.hand, hold.pushes() ? kOff : 0);
    // Over an edge: level above it, then down behind it.
    Pose above = at;
    if (hooks) above.position.z() += hold.deep + kOverEdge;
    Pose before = above;
    if (hooks) {
      const Vec3 out = pose.rotation * hold.normal;
      before.position -= kBeforeEdge * Vec3(out.x(), out.y(), 0);
    } else {
      before.position -= kBefore * (at.rotation * Vec3::UnitX());
    }
    std::vector<Pose> moving;
    for (int k = 1; k <= kSamples; ++k) {
      const double by = (aim - seen.joint->position) * k / kSamples;
      moving.push_back(tool_at(hold, moved_part(*seen.joint, pose, by), problem.hand));
    }
    const std::vector<Ball> balls = balls_of(hold, problem.hand).all();
    const double widest = problem.hand.widest_on_way(arm.openness, hold.open);
    auto way = free_way(around, arm.tcp, before, hand_balls(problem.hand, widest).all());
    const FreeLine last{&around, balls};
    const bool is_free = way && (hooks ? last.is_free(before, above) && last.is_free(above, at)
                                       : last.is_free(before, at));
    if (!is_free) {
      ++lack->blocked;
      continue;
    }
    const bool sets_first =
        is_set_first(around, arm.tcp, *way, problem.hand, arm.openness, hold.open);
    if (hooks) way->push_back(above);
    way->push_back(at);
    std::vector<Pose> whole = *way;
    if (hold.pushes()) whole.push_back(tool_at(hold, pose, problem.hand));
    whole.insert(whole.end(), moving.begin(), moving.end());
    if (!reach.follow(arm.joints, whole)) {
      if (!is_found) lack->add_out_of_reach(reach, arm.joints, at);
      continue;
    }
    const bool is_best = hold.pushes() || comes_back(arm, reach, std::move(whole));
    if (is_found && !is_best) continue;
    is_found = true;
    hold_ = hold;
    way_ = std::move(*way);
    sets_first_ = sets_first;
    least_ = hooks ? seen.joint->closed + kEdgeLeast * (far_of(*seen.joint) - seen.joint->closed)
                   : goal_.least;
    if (is_best) break;
  }
  return is_found;
}

bool JointSkill::comes_back(const Arm& arm, const Reach& reach, std::vector<Pose> way) const {
  if (!reach.may_twist()) return true;
  Pose off = way.back();
  off.position -= kBefore * (off.rotation * Vec3::UnitX());
  way.push_back(off);
  way.push_back(ready_);
  return reach.follow(arm.joints, way).has_value();
}

// Off the part the way the hand came.
void JointSkill::way_back(const policy::Privileged& view, const Arm& arm, const Reach& reach) {
  Pose off = arm.tcp;
  if (hold_->pushes()) {
    const Pose pose = view.base.inverse() * part(view).pose;
    off.position += 0.02 * (pose.rotation * hold_->normal);
  }
  Pose away = off;
  away.position -= kBefore * (away.rotation * Vec3::UnitX());
  way_.clear();
  if (hold_->pushes()) way_.push_back(off);
  way_.push_back(away);
  if ((arm.tcp.rotation * Vec3::UnitX()).z() < -kFromAbove) return;
  const Surroundings around = surroundings_of(view);
  // Off the part they open on the way, for what comes next.
  const robot::HandShape& hand = reach.hand().shape;
  const std::vector<Ball> balls = hand_balls(hand, hand.opening_half).all();
  if (const auto home = free_way(around, away, ready_, balls))
    way_.insert(way_.end(), home->begin(), home->end());
}

// What cannot be planned from here may be from where the tool began.
void JointSkill::way_home(const policy::Privileged& view, const Arm& arm, const Reach& reach) {
  const robot::HandShape& hand = reach.hand().shape;
  const std::vector<Ball> balls = hand_balls(hand, hand.gap_at(arm.openness)).all();
  const auto way = free_way(surroundings_of(view), arm.tcp, ready_, balls);
  way_ = way ? *way : std::vector<Pose>{ready_};
}

void JointSkill::try_again(double position) {
  const bool went_on = std::abs(position - begun_) > kProgress * std::abs(goal_.aim - begun_);
  if (went_on) failed_.clear();
  if (hold_ && !went_on) failed_.push_back(*hold_);
  const double turned = slides_ ? 100 : 180 / std::numbers::pi;
  lack_ =
      fmt::format("it stands at {:.1f} {} and should at {:.1f}, after {} holds", turned * position,
                  slides_ ? "cm" : "deg", turned * least_, tries_ + parts_ + 1);
  if (went_on && ++parts_ < kMostParts) return enter(Phase::kPlan);
  enter(++tries_ < kMostHoldTries ? Phase::kPlan : Phase::kOver);
}

void JointSkill::advance_move(double position) {
  const bool is_part = aim_ != goal_.aim;
  if (goal_.met(position, is_part ? aim_ : goal_.enough)) return enter(Phase::kLetGo);
  const bool stuck = still_ >= kPatience || steps_ >= kLongestMove;
  if (stuck) enter(Phase::kLetGo);
}

void JointSkill::advance(const policy::Privileged& view, const Arm& arm, const Reach& reach) {
  const PartJoint& joint = *part(view).joint;
  switch (phase_) {
    case Phase::kPlan:
      if (!planned_) goal_ = goal_of(skill_, joint), slides_ = joint.slides;
      planned_ = true;
      reached_ = goal_.met(joint.position, goal_.enough);
      if (reached_) return enter(Phase::kOver);
      if (plan(view, arm, reach)) return enter(sets_first_ ? Phase::kSet : Phase::kGo);
      reached_ = goal_.met(joint.position, goal_.least);
      if (reached_ || homes_ >= kMostHomes || is_near(arm.tcp, ready_, 0.05, 0.3))
        return enter(Phase::kOver);
      ++homes_;
      way_home(view, arm, reach);
      return enter(Phase::kHome);
    case Phase::kHome:
      if (!is_near(arm.tcp, way_[next_], 0.03, 0.2) && steps_ < 20) return;
      steps_ = 0;
      return ++next_ < way_.size() ? void() : enter(Phase::kPlan);
    case Phase::kSet:
      if (are_set(arm.openness, hold_->open, steps_)) enter(Phase::kGo);
      return;
    case Phase::kGo: {
      const bool is_last = next_ + 1 >= way_.size();
      const bool is_next_last = next_ + 2 >= way_.size();
      const bool is_before_edge = hold_->reaches_over() && next_ + 3 == way_.size();
      const double shift = is_last ? 0.004 : is_next_last || is_before_edge ? 0.010 : 0.030;
      still_ = is_near(arm.tcp, at_, kStands, 0.01) ? still_ + 1 : 0;
      at_ = arm.tcp;
      const bool stands = still_ >= 3 || steps_ >= 25;
      if (!is_near(arm.tcp, way_[next_], shift, is_last ? 0.05 : 0.15)) {
        if (!stands) return;
        // It comes no nearer: near enough, or another hold.
        const double off = hold_->pushes() ? 4 * shift : 3 * shift;
        if (!is_near(arm.tcp, way_[next_], off, 0.3)) return enter(Phase::kLetGo);
      }
      // Fingers are set before they go where there is little room.
      const bool stays = hold_->pushes() || std::abs(arm.openness - openness_) < 0.01;
      if (is_next_last && !is_last && !stays && steps_ < 25) return;
      steps_ = still_ = 0;
      if (++next_ >= way_.size()) return enter(Phase::kMeet);
      if (next_ + 1 == way_.size()) refine(view, arm, reach);
      return;
    }
    case Phase::kMeet:
      if (steps_ < 1 || only_reaches_) return;
      return enter(hold_->pushes() ? Phase::kMove : Phase::kGrip);
    case Phase::kGrip:
      if (steps_ >= 2 && (std::abs(arm.openness - openness_) < 0.02 || steps_ >= 6))
        return enter(Phase::kMove);
      return;
    case Phase::kMove:
      return advance_move(joint.position);
    case Phase::kLetGo:
      if (!hold_->pushes() && steps_ < 2) return;
      way_back(view, arm, reach);
      return enter(Phase::kBack);
    case Phase::kBack:
      if (!is_near(arm.tcp, way_[next_], 0.025, 0.2) && steps_ < (next_ < near_legs() ? 12 : 25))
        return;
      steps_ = 0;
      if (++next_ < way_.size()) return;
      // A button comes back.
      reached_ = skill_.kind == policy::Skill::Kind::kPress || goal_.met(joint.position, least_);
      return reached_ ? enter(Phase::kOver) : try_again(joint.position);
    case Phase::kOver:
      return;
  }
}

policy::Action JointSkill::command(const policy::Privileged& view, const Arm& arm, Servo& servo,
                                   const Reach& reach) {
  const robot::HandShape& hand = reach.hand().shape;
  if (phase_ == Phase::kHome)
    return servo.toward(way_[next_], arm, robot::command_of_openness(arm.openness), kFarPace);
  const double open = robot::command_of_openness(hold_->open);
  switch (phase_) {
    case Phase::kSet:
      return servo.hold(arm, open);
    case Phase::kGo: {
      const bool is_last = next_ + 1 >= way_.size();
      const bool is_near = is_last || (hold_->reaches_over() && next_ + 2 >= way_.size());
      return servo.toward(way_[next_], arm, open, is_near ? kNearHold : kFarPace);
    }
    case Phase::kMeet:
      return servo.settle(way_.back(), arm, open);
    case Phase::kGrip:
      return servo.settle(way_.back(), arm, kClosedGripper);
    case Phase::kMove: {
      const policy::PrivilegedFixture& seen = part(view);
      const PartJoint& joint = *seen.joint;
      const Pose pose = view.base.inverse() * seen.pose;
      const double ahead =
          joint.slides ? kAhead : std::min(kMostAhead, kAhead / lever_of(*hold_, joint));
      const double left = std::abs(aim_ - joint.position);
      // What must be pressed shut is pressed.
      const double by =
          skill_.kind == policy::Skill::Kind::kClose || skill_.kind == policy::Skill::Kind::kPress
              ? std::min(ahead, left + 0.3 * ahead)
              : std::min(ahead, left);
      const double press =
          joint.slides ? kPress : std::min(kPress, kPressLever * lever_of(*hold_, joint));
      const Pose goal = tool_at(*hold_, moved_part(joint, pose, goal_.up ? by : -by), hand, -press);
      return servo.toward(goal, arm, kClosedGripper, press < kPress ? kTurnPace : kMovePace);
    }
    case Phase::kLetGo:
      return servo.settle(arm.tcp, arm, open);
    case Phase::kBack:
      if (next_ < near_legs()) return servo.toward(way_[next_], arm, open, kMovePace);
      return servo.toward(way_[next_], arm, robot::command_of_openness(hand.widest()), kFarPace);
    case Phase::kPlan:
    case Phase::kHome:
    case Phase::kOver:
      break;
  }
  return servo.hold(arm, kOpenGripper);
}

std::optional<policy::Action> JointSkill::act(const policy::Privileged& view, const Arm& arm,
                                              Servo& servo, const Reach& reach) {
  const PartJoint& joint = *part(view).joint;
  if (phase_ == Phase::kMove) {
    const double lever = hold_ ? lever_of(*hold_, joint) : 1;
    still_ = std::abs(joint.position - last_) * lever < kSticks ? still_ + 1 : 0;
  }
  // Phases that are done take no time; each leads on, so this ends.
  for (int i = 0; i < 12; ++i) {
    const Phase before = phase_;
    const int tries = tries_;
    advance(view, arm, reach);
    if (phase_ == before && tries == tries_) break;
  }
  last_ = joint.position;
  openness_ = arm.openness;
  ++steps_;
  if (phase_ == Phase::kOver) return std::nullopt;
  return command(view, arm, servo, reach);
}

}  // namespace probe::expert
