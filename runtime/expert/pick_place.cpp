#include "runtime/expert/pick_place.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "runtime/expert/place_candidates.h"
#include "runtime/robot/grip_command.h"
#include "runtime/robot/rotation.h"

namespace probe::expert {
namespace {

constexpr int kMostTries = 3;
constexpr double kCareful = 0.4;  // more steps with each try
constexpr int kStepsOfATry = 24;  // fewer left: another try cannot end in time

constexpr double kOffSpot = 0.05, kOnSpot = 0.03;  // m, of what was put

constexpr const char* kLost = "it slipped in the hand";

constexpr double kThin = 0.015;       // m high
constexpr double kFlat = 0.030;       // m high: what is dragged
constexpr double kLies = 0.010;       // m from the surface
constexpr double kDeep = 0.09;        // m: walls as high are not passed aslant
constexpr double kAroundPlace = 0.04;   // m
constexpr double kOverWalls = 0.015;  // m
constexpr int kLongestDrag = 40;      // steps
constexpr int kLongestShove = 8;      // steps
constexpr double kLift = 0.12;        // m, of what is picked up
constexpr int kLongestLift = 10;      // steps
constexpr double kShoved = 0.038;     // m that are enough
constexpr int kLongestApproach = 30;  // steps in which a source that moves is followed

constexpr Pace kNearPace{.shift = 0.030, .turn = 0.20};
constexpr Pace kHeldPace{.shift = 0.040, .turn = 0.20, .gain = 0.015};
constexpr Pace kTouchPace{.shift = 0.015, .turn = 0.10, .lead = false};

bool all_fingers(const Scene& s) {
  const auto on = [](bool touches) { return touches; };
  return !s.fingers_on_source.empty() && std::ranges::all_of(s.fingers_on_source, on);
}

}  // namespace

JointVector joints_of(const Scene& s, const Reach& reach) {
  return Eigen::Map<const JointVector>(s.joints.data(),
                                       static_cast<Eigen::Index>(reach.chain().joint_count()));
}

namespace {

// With another spot for its target.
Scene marked(Scene scene, const PutSpot& spot, const policy::Privileged& view) {
  return with_target_at(std::move(scene), spot_now(spot, view));
}

}  // namespace

void PickPlace::begin(const Errand& errand, const policy::Privileged& view, const Scene& scene) {
  *this = {};
  errand_ = errand;
  first_seen_ = scene.source.center;
  last_ = errand_.spots.empty() ? scene : marked(scene, errand_.spots.front(), view);
}

void PickPlace::enter(Phase phase) {
  phase_ = phase;
  steps_ = 0;
}

policy::Action PickPlace::act(Scene scene, const Means& means) {
  if (!errand_.spots.empty()) scene = marked(std::move(scene), errand_.spots[spot_], means.view);
  // Phases that are done take no time; each leads on, so this ends.
  for (int i = 0; i < 12; ++i) {
    const Phase before = phase_;
    advance(scene, means);
    if (phase_ == before) break;
  }
  const policy::Action action = command(scene, means.servo);
  ++steps_;
  last_ = std::move(scene);
  return action;
}

// Opens and begins again, or gives up and keeps still.
void PickPlace::start_over(const Means& means, const char* lack) {
  lack_ = lack;
  if (pick_) failed_.push_back(pick_->source_pose.inverse() * pick_->grasp.tcp);
  const bool again = ++tries_ < kMostTries && means.steps_left >= kStepsOfATry;
  pick_.reset();
  path_.reset();
  enter(again ? Phase::kRaise : Phase::kRest);
}

// The source still where it was taken, seen from the tool.
bool PickPlace::holds(const Scene& s) const {
  const Vec3 in_hand = s.tcp.inverse().apply(s.source_pose.position);
  return (in_hand - in_hand_).norm() < 0.025;
}

void PickPlace::advance(const Scene& s, const Means& means) {
  switch (phase_) {
    case Phase::kRaise:
      return advance_raise(s, means);
    case Phase::kApproach:
      return advance_approach(s, means);
    case Phase::kShove:
      if (!is_near(s.tcp, shove_->end, 0.006, 0.2) && steps_ < kLongestShove) return;
      release_ = s.tcp;
      return enter(Phase::kRetreat);
    case Phase::kClose:
      return advance_close(s, means);
    case Phase::kTransport:
      return advance_transport(s, means);
    case Phase::kLower:
      return advance_lower(s, means);
    case Phase::kDrag:
      if (!holds(s)) return start_over(means, kLost);
      if (is_near(s.tcp, place_, 0.01, 0.3) || steps_ >= kLongestDrag) enter(Phase::kLoosen);
      return;
    case Phase::kLift:
      if (!holds(s)) return start_over(means, kLost);
      if (is_near(s.tcp, place_, 0.01, 0.2) || steps_ >= kLongestLift) enter(Phase::kKeep);
      return;
    case Phase::kKeep:
      if (!holds(s)) start_over(means, kLost);
      return;
    case Phase::kLoosen:
      if (steps_ >= 1) enter(Phase::kOpen);
      return;
    case Phase::kOpen:
      if (steps_ >= 2 && (s.openness > 0.75 * let_go_ || steps_ >= 4)) {
        release_ = s.tcp;
        enter(Phase::kRetreat);
      }
      return;
    case Phase::kRetreat:
      if (s.tcp.position.z() < release_.position.z() + 0.055 && steps_ < 6) return;
      if (shove_ ? (s.source.center - first_seen_).norm() > kShoved : is_put(s)) {
        lack_ = shove_ && !errand_.pushes ? no_hold(s) + " and pushed it" : "";
        return enter(Phase::kRest);
      }
      return start_over(
          means, shove_ ? "it was pushed and hardly moved" : "it does not lie where it was put");
    case Phase::kRest:
      return;
  }
}

// With both widths where they are why.
std::string PickPlace::no_hold(const Scene& s) {
  const double width = least_width(s.source.whole), opens = 2 * s.hand.opening_half;
  if (width < opens) return "the hand finds no hold of it";
  return fmt::format("the hand, which opens to {:.1f} cm, finds no hold of it, {:.1f} cm where it is narrowest,",
                     100 * opens, 100 * width);
}

bool PickPlace::is_put(const Scene& s) const {
  if (errand_.spots.empty()) return lies_on_target(s);
  return (s.source.center - s.target.center).norm() < kOffSpot &&
         s.source.bottom < s.target.top + kOnSpot;
}

void PickPlace::advance_raise(const Scene& s, const Means& means) {
  const double high = travel_height(s, s.hand.tip_below, s.tcp.position, s.tcp.position);
  const bool clear = s.tcp.position.z() > high - 0.01;
  const bool open = s.openness > 0.8 || steps_ >= 3;
  const bool still = (s.source_pose.position - last_.source_pose.position).norm() < 0.002;
  if (!(clear && open && still) && steps_ < 8) return;
  if (plan_to_grasp(s, means)) return enter(Phase::kApproach);
  if (lack_.empty()) lack_ = "the arm follows no way to a hold of it from above";
  enter(Phase::kRest);
}

bool PickPlace::plan_to_grasp(const Scene& s, const Means& means) {
  pick_ = plan_pick(s, means.reach, errand_.close && !errand_.lifts, failed_);
  shove_.reset();
  // A thin rim that slipped once slips again.
  const int rims = s.source.top - s.source.bottom < kThin ? 1 : 2;
  const bool needs_shove = !pick_ || (pick_->grasp.rim && tries_ >= rims);
  if (errand_.pushes || (errand_.close && !errand_.lifts && errand_.may_shove && needs_shove)) {
    shove_ = plan_shove(s, means.reach);
    if (shove_) pick_ = shove_->start;
  }
  if (!pick_) return false;
  path_ = plan_approach(s, means.reach, *pick_, means.recent);
  path_step_ = 0;
  return path_.has_value();
}

// Something pushed the source since the plan was made.
bool PickPlace::moved_since_plan(const Scene& s) const {
  const robot::PoseError e = robot::pose_error(s.source_pose, pick_->source_pose);
  return e.position > 0.004 || e.rotation > 0.06;
}

void PickPlace::advance_approach(const Scene& s, const Means& means) {
  if (moved_since_plan(s) && steps_ < kLongestApproach) {
    const auto old_pick = pick_;
    const auto old_path = path_;
    const int old_step = path_step_;
    if (!plan_to_grasp(s, means)) {
      pick_ = old_pick;
      path_ = old_path;
      path_step_ = old_step;
    }
  }
  if (!path_done()) return;
  // Wide objects leave the fingers little room, so the end must be met.
  const Phase next = shove_ ? Phase::kShove : Phase::kClose;
  if (is_near(s.tcp, pick_->grasp.tcp, 0.003, 0.04)) return enter(next);
  if (path_step_ < path_->path.steps() + 3) return;
  if (is_near(s.tcp, pick_->grasp.tcp, 0.010, 0.15)) return enter(next);
  start_over(means, "the hand does not come to its hold");
}

void PickPlace::advance_close(const Scene& s, const Means& means) {
  if (!errand_.close) return;  // the one that only reaches stays here
  if (steps_ < 2) return;
  if (all_fingers(s)) {
    in_hand_ = s.tcp.inverse().apply(s.source_pose.position);
    taken_ = s.tcp;
    taken_bottom_ = s.source.bottom;
    if (errand_.lifts) return begin_lift();
    return is_dragged(s) ? begin_drag(s) : begin_transport(s, means);
  }
  if (steps_ >= 4) start_over(means, "not all fingers touch it when they close");
}

// A thin thing that is held by its rim swings in the air; along the surface that it lies on, to a
// place of the same surface, it need not be lifted.
bool PickPlace::is_dragged(const Scene& s) const {
  if (!s.low_ways || !pick_->grasp.rim || errand_.keeps || errand_.spots.empty()) return false;
  const PutSpot& spot = errand_.spots[spot_];
  return spot.object < 0 && spot.fixture < 0 && s.source.top - s.source.bottom < kFlat &&
         s.source.bottom < s.surface + kLies && std::abs(s.target.top - s.surface) < kLies;
}

void PickPlace::begin_drag(const Scene& s) {
  place_ = taken_;
  place_.position.head<2>() += s.target.center - s.source.center;
  enter(Phase::kDrag);
}

void PickPlace::begin_lift() {
  place_ = taken_;
  place_.position.z() += kLift;
  enter(Phase::kLift);
}

// With what is in the hand as it is, the spot where it stands best.
void PickPlace::choose_spot(const Scene& s, const Means& means) {
  const JointVector q = joints_of(s, means.reach);
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < errand_.spots.size(); ++i) {
    Scene scene = s;
    scene.target = {};
    scene = marked(std::move(scene), errand_.spots[i], means.view);
    const auto place =
        plan_place(scene, means.reach, std::span(q.data(), std::size_t(q.size())), true);
    if (!place || place->cost + errand_.spots[i].cost >= least) continue;
    least = place->cost + errand_.spots[i].cost;
    spot_ = i;
  }
}

void PickPlace::begin_transport(Scene s, const Means& means) {
  const bool on_mark = !errand_.spots.empty() && !errand_.keeps;
  if (on_mark) {
    choose_spot(s, means);
    s.target = {};
    s = marked(std::move(s), errand_.spots[spot_], means.view);
  }
  const JointVector q = joints_of(s, means.reach);
  const auto place =
      plan_place(s, means.reach, std::span(q.data(), std::size_t(q.size())), on_mark);
  if (!place) return start_over(means, "the arm follows no way to a place for it");
  place_ = place->tcp;
  let_go_ = place->openness;
  Pose end = place_;
  if (on_mark) end.position.z() += depth_of(s);
  path_ = plan_transport(s, means.reach, end, means.recent, 1 + kCareful * tries_);
  path_step_ = 0;
  if (!path_) return start_over(means, "the arm follows no way to a place for it");
  enter(Phase::kTransport);
}

// How much higher than its place the source passes what stands around a deep one; 0 of a place that
// is not deep, or of an arm with time to go over everything.
double PickPlace::depth_of(const Scene& s) {
  if (!s.low_ways) return 0;
  Outline there = s.source.whole;
  for (Vec2& p : there) p += s.target.center - s.source.center;
  double top = s.target.top;
  for (const Footprint* other : others_of(s, false)) {
    for (std::size_t i = 0; i < other->parts.size(); ++i) {
      if (other->parts[i].size() < 3 || other->part_tops[i] <= top) continue;
      if (separation(there, other->parts[i]) < kAroundPlace) top = other->part_tops[i];
    }
  }
  const double depth = top - s.target.top;
  return depth > kDeep ? depth + kOverWalls : 0;
}

bool PickPlace::lifted_enough(const Scene& s, double rise) const {
  return holds(s) && s.source.bottom - taken_bottom_ > 0.3 * rise - 0.005;
}

void PickPlace::advance_transport(const Scene& s, const Means& means) {
  const double rise = s.tcp.position.z() - taken_.position.z();
  if (!holds(s) || (rise > 0.02 && !lifted_enough(s, rise))) return start_over(means, kLost);
  if (!path_done()) return;
  const double off = (carry_goal(s) - s.tcp.position).head<2>().norm();
  if (off < 0.006 || path_step_ >= path_->path.steps() + 3) enter(Phase::kLower);
}

void PickPlace::advance_lower(const Scene& s, const Means& means) {
  if (!holds(s)) return start_over(means, kLost);
  const bool stopped = steps_ >= 3 && last_.tcp.position.z() - s.tcp.position.z() < 0.0008;
  if (gap_to_target(s) < 0.0025 || stopped || steps_ >= 9)
    enter(errand_.keeps ? Phase::kKeep : Phase::kLoosen);
}

double PickPlace::parted() const {
  const double open = pick_->grasp.open;
  return open < 1 ? robot::command_of_openness(open) : kOpenGripper;
}

double PickPlace::wide() const {
  return let_go_ < 1 ? robot::command_of_openness(let_go_) : kOpenGripper;
}

policy::Action PickPlace::command(const Scene& s, Servo& servo) {
  switch (phase_) {
    case Phase::kRaise:
      return command_raise(s, servo);
    case Phase::kApproach:
      return follow_path(s, servo, shove_ && shove_->closed ? kClosedGripper : parted());
    case Phase::kShove:
      return servo.toward(shove_->end, arm_of(s), shove_->closed ? kClosedGripper : kOpenGripper,
                          kNearPace);
    case Phase::kClose:
      return servo.settle(pick_->grasp.tcp, arm_of(s),
                          errand_.close ? kClosedGripper : kOpenGripper);
    case Phase::kTransport:
      return follow_path(s, servo, kClosedGripper);
    case Phase::kLower:
      return command_lower(s, servo);
    case Phase::kDrag:
      return servo.toward(place_, arm_of(s), kClosedGripper, kNearPace);
    case Phase::kLift:
      return servo.toward(place_, arm_of(s), kClosedGripper, kHeldPace);
    case Phase::kKeep:
      return servo.hold(arm_of(s), kClosedGripper);
    case Phase::kLoosen:
      return command_loosen(s, servo);
    case Phase::kOpen:
      return servo.hold(arm_of(s), wide());
    case Phase::kRetreat: {
      Pose goal = release_;
      goal.position.z() += 0.075;
      return servo.toward(goal, arm_of(s), wide(), kHeldPace);
    }
    case Phase::kRest:
      return servo.hold(arm_of(s), kOpenGripper);
  }
  return servo.hold(arm_of(s), kOpenGripper);
}

policy::Action PickPlace::follow_path(const Scene& s, Servo& servo, double gripper) {
  const JointVector next = path_->path.at(++path_step_);
  return servo.follow(std::span(next.data(), std::size_t(next.size())), arm_of(s), gripper);
}

// Opens first: a half-held source must not come along.
policy::Action PickPlace::command_raise(const Scene& s, Servo& servo) {
  if (s.openness < 0.5 && steps_ < 2) return servo.hold(arm_of(s), kOpenGripper);
  Pose goal = s.tcp;
  goal.position.z() = std::max(goal.position.z(),
                               travel_height(s, s.hand.tip_below, s.tcp.position, s.tcp.position));
  return servo.toward(goal, arm_of(s), kOpenGripper, kHeldPace);
}

policy::Action PickPlace::command_lower(const Scene& s, Servo& servo) {
  const double gap = gap_to_target(s);
  Pose goal = place_;
  goal.position = carry_goal(s);
  goal.position.z() -= gap;
  return servo.toward(goal, arm_of(s), kClosedGripper, gap > 0.02 ? kNearPace : kTouchPace);
}

// Takes back what the target leads ahead, and opens by a few millimetres so that nothing is
// flung.
policy::Action PickPlace::command_loosen(const Scene& s, Servo& servo) {
  Pose goal = s.tcp;
  goal.rotation = place_.rotation;
  // Openness is over the fingers' travel; the command's range is a little wider.
  const double gripper = robot::command_of_openness(s.openness + 0.20);
  return servo.settle(goal, arm_of(s), gripper);
}

}  // namespace probe::expert
