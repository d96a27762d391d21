// The phases of a pick and place. Each control step the expert looks, moves on through phases that
// are done, and asks the servo for one action. The two long moves follow planned paths. A grasp
// that is lost, or a source that is not on the target in the end, starts it over.
#include "runtime/expert/expert.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "runtime/expert/away.h"
#include "runtime/expert/joint_skill.h"
#include "runtime/expert/path_planner.h"
#include "runtime/expert/place_candidates.h"
#include "runtime/expert/put_spot.h"
#include "runtime/expert/servo.h"
#include "runtime/expert/shove.h"
#include "runtime/expert/waypoints.h"
#include "runtime/expert/wrong_skills.h"
#include "runtime/robot/grip_command.h"
#include "runtime/robot/rotation.h"

namespace probe::expert {
namespace {

enum class Phase {
  kRaise,      // straight up until the fingers clear everything, opening
  kApproach,   // to the grasp, on a planned path
  kShove,      // instead of all that follows, for what cannot be gripped: it is pushed
  kClose,      // still, fingers closing
  kTransport,  // with the source to the place, on a planned path
  kLower,      // until the source rests on the target
  kLift,       // instead of a transport, for what shall only be picked up: straight up
  kKeep,       // instead of all that follows, for what shall not lie on the target: still, closed
  kLoosen,     // fingers just off the source
  kOpen,       // fingers wide
  kRetreat,    // straight up
  kRest,       // still to the end
};

constexpr double kOpenGripper = 1, kClosedGripper = -1;
constexpr int kMostTries = 3;
constexpr double kCareful = 0.4;  // more steps with each try
constexpr int kStepsOfATry = 24;  // fewer left: another try cannot end in time

constexpr double kOffSpot = 0.05, kOnSpot = 0.03;  // m, of what was put

constexpr double kThin = 0.015;       // m high
constexpr int kLongestShove = 8;      // steps
constexpr double kLift = 0.12;        // m, of what is picked up
constexpr int kLongestLift = 10;      // steps
constexpr double kShoved = 0.038;     // m that are enough
constexpr int kLongestApproach = 30;  // steps in which a source that moves is followed

constexpr Pace kNearPace{.shift = 0.030, .turn = 0.20};
constexpr Pace kHeldPace{.shift = 0.040, .turn = 0.20, .gain = 0.015};
constexpr Pace kTouchPace{.shift = 0.015, .turn = 0.10, .lead = false};

class Expert final : public policy::Policy {
 public:
  explicit Expert(const ExpertOptions& options) : options_(options) {}

  Status begin(const policy::EpisodeStart& start) override {
    reach_.reset();
    if (start.robot == nullptr) {
      return Failure{Fault::kPolicy, "the expert was told of no robot", ""};
    }
    PROBE_ASSIGN(Reach reach, Reach::create(*start.robot));
    reach_ = std::move(reach);
    horizon_ = start.horizon;
    law_ = start.robot->law;
    rate_ = start.control_hz > 0 ? start.control_hz : 5;
    until_decision_ = 0;
    started_ = false;
    tries_ = 0;
    failed_.clear();
    pick_.reset();
    shove_.reset();
    path_.reset();
    spot_.reset();
    put_spot_.reset();
    pushes_ = false;
    solution_.clear();
    skill_ = 0;
    skill_begun_ = false;
    enter(Phase::kRaise);
    return {};
  }

  Result<policy::Action> act(const policy::Observation& observation) override {
    if (!started_ && observation.privileged != nullptr)
      solution_ = skills_of(*observation.privileged);
    // Nothing to do wrong.
    if (options_.source > 1 && solution_.empty() && observation.privileged != nullptr &&
        !observation.privileged->solution.empty())
      return policy::Action{0, 0, 0, 0, 0, 0, kOpenGripper};
    PROBE_TRY(check(observation));
    if (started_ && --until_decision_ > 0) {
      const policy::Proprioception& now = observation.proprioception;
      const auto q = std::span(now.joints).first(reach_->chain().joint_count());
      return servo_.next({reach_->chain().pose(q), now.joints, now.openness});
    }
    const policy::Privileged& view = *observation.privileged;
    Scene scene = seen(observation);
    if (!started_) {
      lifts_ = options_.close && view.goal == policy::Goal::kLifted;
      if (solution_.empty()) look_for_spot(observation, scene);
    }
    if (spot_) scene = with_spot(std::move(scene), *spot_);
    if (observation.horizon > 0) horizon_ = observation.horizon;
    const Arm arm = arm_of(scene);
    if (!started_) {
      servo_.begin(reach_->chain(), arm, law_, rate_);
      ready_ = arm.tcp;
      last_ = scene;
      started_ = true;
      first_seen_ = scene.source.center;
      recent_.assign(Path::kPast, joints_of(scene));
    }
    // Time passes in decisions.
    until_decision_ = servo_.interval();
    steps_left_ = (horizon_ - observation.step) / servo_.interval();
    recent_.erase(recent_.begin());
    recent_.push_back(joints_of(scene));
    // A source in the air hinders the arm no more than an empty hand.
    const bool touched =
        std::ranges::any_of(scene.fingers_on_source, [](bool touches) { return touches; });
    servo_.observe(arm,
                   !moves_joint() && (!touched || (phase_ == Phase::kTransport && steps_ > 1)));
    return !solution_.empty() ? act_by_solution(observation) : act_on(scene);
  }

 private:
  // What the skills of a solution are done with, or else the roles.
  Scene seen(const policy::Observation& observation) const {
    const policy::Privileged& view = *observation.privileged;
    if (solution_.empty())
      return look(
          observation,
          {view.object_of(options_.source), options_.close ? view.object_of(options_.target) : -1},
          reach_->hand());
    const bool is_over = skill_ >= solution_.size();
    const policy::Skill skill = is_over ? policy::Skill{} : solution_[skill_];
    Scene scene = look(observation, {skill.object, goes_to_spot(skill) ? -1 : skill.to_object},
                       reach_->hand());
    return put_spot_ ? with_target_at(std::move(scene), spot_now(*put_spot_, view)) : scene;
  }

  // The skills of this episode; else the usual pick and place.
  std::vector<policy::Skill> skills_of(const policy::Privileged& view) const {
    if (options_.source > 1) return wrong_skills(view, options_.source);
    std::vector<policy::Skill> skills = view.solution;
    // What only reaches goes to the first thing that is done something with.
    if (!options_.close && !skills.empty()) skills.resize(1);
    return skills;
  }
  // The skill that is being done.
  bool moves_joint() const {
    return !solution_.empty() && skill_ < solution_.size() && solution_[skill_].fixture >= 0;
  }

  // The usual phases, of one object.
  policy::Action act_on(const Scene& scene) {
    // Phases that are done take no time; each leads on, so this ends.
    for (int i = 0; i < 12; ++i) {
      const Phase before = phase_;
      advance(scene);
      if (phase_ == before) break;
    }
    const policy::Action action = command(scene);
    ++steps_;
    last_ = scene;
    return action;
  }

  // Skill by skill; one that is done takes no time.
  policy::Action act_by_solution(const policy::Observation& observation) {
    const policy::Privileged& view = *observation.privileged;
    while (skill_ < solution_.size()) {
      const policy::Skill& skill = solution_[skill_];
      const bool is_new = !skill_begun_;
      skill_begun_ = true;
      if (skill.fixture >= 0) {
        if (is_new) joint_.begin(skill, ready_, !options_.close);
        const Scene scene = seen(observation);
        if (const auto action = joint_.act(view, arm_of(scene), servo_, *reach_)) return *action;
      } else {
        if (is_new) begin_object_skill(observation, skill);
        const policy::Action action = act_on(seen(observation));
        const bool is_over = phase_ == Phase::kRest || phase_ == Phase::kKeep;
        if (!is_over || skill_ + 1 >= solution_.size()) return action;
      }
      ++skill_;
      skill_begun_ = false;
      put_spot_.reset();
    }
    return servo_.hold(arm_of(seen(observation)), kOpenGripper);
  }

  void begin_object_skill(const policy::Observation& observation, const policy::Skill& skill) {
    lifts_ = skill.kind == policy::Skill::Kind::kPick;
    pushes_ = skill.kind == policy::Skill::Kind::kPush;
    tries_ = 0;
    failed_.clear();
    pick_.reset();
    shove_.reset();
    path_.reset();
    put_spot_.reset();
    const Scene scene = seen(observation);
    if (options_.close && skill.kind == policy::Skill::Kind::kPut && goes_to_spot(skill))
      put_spot_ = find_put_spot(scene, *observation.privileged, skill, *reach_);
    first_seen_ = scene.source.center;
    last_ = seen(observation);
    const bool has_place = !options_.close || skill.kind != policy::Skill::Kind::kPut ||
                           !goes_to_spot(skill) || put_spot_;
    enter(has_place ? Phase::kRaise : Phase::kRest);
  }

  Status check(const policy::Observation& observation) const {
    if (!reach_)
      return Failure{Fault::kPolicy, "the expert was asked to act before an episode began", ""};
    if (observation.privileged == nullptr) {
      return Failure{Fault::kPolicy, "the expert needs the privileged view and got none", ""};
    }
    const policy::Privileged& view = *observation.privileged;
    if (!solution_.empty()) return check_joints(observation);
    const bool lacks_target = options_.close && view.goal != policy::Goal::kLifted &&
                              view.goal != policy::Goal::kAway &&
                              view.object_of(options_.target) < 0;
    // What only reaches, or goes for a distractor, does so whatever the goal is.
    const bool is_other =
        options_.close && options_.source == 0 && view.goal == policy::Goal::kOther;
    const auto is_missing = [&](int role) { return role > 1 && view.object_of(role) < 0; };
    if (is_missing(options_.source) || (options_.close && is_missing(options_.target))) {
      return Failure{Fault::kPolicy,
                     fmt::format("the expert works on roles {} and {}, the episode has {} objects",
                                 options_.source, options_.target, view.objects.size()),
                     ""};
    }
    if (view.object_of(options_.source) < 0 || lacks_target || is_other)
      return Failure{Fault::kPolicy, std::string(policy::kNoSolution), ""};
    return check_joints(observation);
  }

  Status check_joints(const policy::Observation& observation) const {
    if (observation.proprioception.joints.size() < reach_->chain().joint_count()) {
      return Failure{
          Fault::kPolicy,
          fmt::format("the expert needs {} joint positions and got {}",
                      reach_->chain().joint_count(), observation.proprioception.joints.size()),
          ""};
    }
    return {};
  }

  // Only once an episode: the source must not be led from spot to spot.
  void look_for_spot(const policy::Observation& observation, const Scene& scene) {
    if (options_.close && observation.privileged->goal == policy::Goal::kAway)
      spot_ = find_spot(scene, *reach_);
  }

  void enter(Phase phase) {
    phase_ = phase;
    steps_ = 0;
  }

  // Opens and begins again, or gives up and keeps still.
  void start_over() {
    if (pick_) failed_.push_back(pick_->source_pose.inverse() * pick_->grasp.tcp);
    const bool again = ++tries_ < kMostTries && steps_left_ >= kStepsOfATry;
    pick_.reset();
    path_.reset();
    enter(again ? Phase::kRaise : Phase::kRest);
  }

  static bool near(const Pose& a, const Pose& b, double shift, double turn) {
    const robot::PoseError e = robot::pose_error(a, b);
    return e.position < shift && e.rotation < turn;
  }

  static Arm arm_of(const Scene& s) { return {s.tcp, s.joints, s.openness}; }

  bool all_fingers(const Scene& s) const {
    const auto on = [](bool touches) { return touches; };
    return !s.fingers_on_source.empty() && std::ranges::all_of(s.fingers_on_source, on);
  }

  // The source still where it was taken, seen from the tool.
  bool holds(const Scene& s) const {
    const Vec3 in_hand = s.tcp.inverse().apply(s.source_pose.position);
    return (in_hand - in_hand_).norm() < 0.025;
  }

  void advance(const Scene& s) {
    switch (phase_) {
      case Phase::kRaise:
        return advance_raise(s);
      case Phase::kApproach:
        return advance_approach(s);
      case Phase::kShove:
        if (!near(s.tcp, shove_->end, 0.006, 0.2) && steps_ < kLongestShove) return;
        release_ = s.tcp;
        return enter(Phase::kRetreat);
      case Phase::kClose:
        return advance_close(s);
      case Phase::kTransport:
        return advance_transport(s);
      case Phase::kLower:
        return advance_lower(s);
      case Phase::kLift:
        if (!holds(s)) return start_over();
        if (near(s.tcp, place_, 0.01, 0.2) || steps_ >= kLongestLift) enter(Phase::kKeep);
        return;
      case Phase::kKeep:
        if (!holds(s)) start_over();
        return;
      case Phase::kLoosen:
        if (steps_ >= 1) enter(Phase::kOpen);
        return;
      case Phase::kOpen:
        if (steps_ >= 2 && (s.openness > 0.75 || steps_ >= 4)) {
          release_ = s.tcp;
          enter(Phase::kRetreat);
        }
        return;
      case Phase::kRetreat:
        if (s.tcp.position.z() < release_.position.z() + 0.055 && steps_ < 6) return;
        if (shove_ ? (s.source.center - first_seen_).norm() > kShoved : is_put(s)) {
          return enter(Phase::kRest);
        }
        return start_over();
      case Phase::kRest:
        return;
    }
  }

  bool is_put(const Scene& s) const {
    if (!put_spot_) return lies_on_target(s);
    return (s.source.center - s.target.center).norm() < kOffSpot &&
           s.source.bottom < s.target.top + kOnSpot;
  }

  void advance_raise(const Scene& s) {
    const bool clear = s.tcp.position.z() > travel_height(s, s.hand.tip_below) - 0.01;
    const bool open = s.openness > 0.8 || steps_ >= 3;
    const bool still = (s.source_pose.position - last_.source_pose.position).norm() < 0.002;
    if (!(clear && open && still) && steps_ < 8) return;
    enter(plan_to_grasp(s) ? Phase::kApproach : Phase::kRest);
  }

  JointVector joints_of(const Scene& s) const {
    return Eigen::Map<const JointVector>(s.joints.data(),
                                         static_cast<Eigen::Index>(reach_->chain().joint_count()));
  }

  bool plan_to_grasp(const Scene& s) {
    pick_ = plan_pick(s, *reach_, options_.close && !lifts_, failed_);
    shove_.reset();
    // A thin rim that slipped once slips again.
    const int rims = s.source.top - s.source.bottom < kThin ? 1 : 2;
    const bool needs_shove = !pick_ || (pick_->grasp.rim && tries_ >= rims);
    if (pushes_ || (options_.close && !lifts_ && !put_spot_ && needs_shove)) {
      shove_ = plan_shove(s, *reach_);
      if (shove_) pick_ = shove_->start;
    }
    if (!pick_) return false;
    path_ = plan_approach(s, *reach_, *pick_, recent_);
    path_step_ = 0;
    return path_.has_value();
  }

  // Something pushed the source since the plan was made.
  bool moved_since_plan(const Scene& s) const {
    const robot::PoseError e = robot::pose_error(s.source_pose, pick_->source_pose);
    return e.position > 0.004 || e.rotation > 0.06;
  }

  bool path_done() const { return path_step_ >= path_->path.steps(); }

  void advance_approach(const Scene& s) {
    if (moved_since_plan(s) && steps_ < kLongestApproach) {
      const auto old_pick = pick_;
      const auto old_path = path_;
      const int old_step = path_step_;
      if (!plan_to_grasp(s)) {
        pick_ = old_pick;
        path_ = old_path;
        path_step_ = old_step;
      }
    }
    if (!path_done()) return;
    // Wide objects leave the fingers little room, so the end must be met.
    const Phase next = shove_ ? Phase::kShove : Phase::kClose;
    if (near(s.tcp, pick_->grasp.tcp, 0.003, 0.04)) return enter(next);
    if (path_step_ < path_->path.steps() + 3) return;
    if (near(s.tcp, pick_->grasp.tcp, 0.010, 0.15)) return enter(next);
    start_over();
  }

  void advance_close(const Scene& s) {
    if (!options_.close) return;  // the one that only reaches stays here
    if (steps_ < 2) return;
    if (all_fingers(s)) {
      in_hand_ = s.tcp.inverse().apply(s.source_pose.position);
      taken_ = s.tcp;
      taken_bottom_ = s.source.bottom;
      return lifts_ ? begin_lift() : begin_transport(s);
    }
    if (steps_ >= 4) start_over();
  }

  void begin_lift() {
    place_ = taken_;
    place_.position.z() += kLift;
    enter(Phase::kLift);
  }

  void begin_transport(const Scene& s) {
    const JointVector q = joints_of(s);
    const auto place = plan_place(s, *reach_, std::span(q.data(), std::size_t(q.size())));
    if (!place) return start_over();
    place_ = place->tcp;
    path_ = plan_transport(s, *reach_, place_, recent_, 1 + kCareful * tries_);
    path_step_ = 0;
    if (!path_) return start_over();
    enter(Phase::kTransport);
  }

  bool lifted_enough(const Scene& s, double rise) const {
    return holds(s) && s.source.bottom - taken_bottom_ > 0.3 * rise - 0.005;
  }

  void advance_transport(const Scene& s) {
    const double rise = s.tcp.position.z() - taken_.position.z();
    if (!holds(s) || (rise > 0.02 && !lifted_enough(s, rise))) return start_over();
    if (!path_done()) return;
    const double off = (carry_goal(s) - s.tcp.position).head<2>().norm();
    if (off < 0.006 || path_step_ >= path_->path.steps() + 3) enter(Phase::kLower);
  }

  void advance_lower(const Scene& s) {
    if (!holds(s)) return start_over();
    const bool stopped = steps_ >= 3 && last_.tcp.position.z() - s.tcp.position.z() < 0.0008;
    if (gap_to_target(s) < 0.0025 || stopped || steps_ >= 9)
      enter(spot_ ? Phase::kKeep : Phase::kLoosen);
  }

  policy::Action command(const Scene& s) {
    switch (phase_) {
      case Phase::kRaise:
        return command_raise(s);
      case Phase::kApproach:
        return follow_path(s, shove_ && shove_->closed ? kClosedGripper : kOpenGripper);
      case Phase::kShove:
        return servo_.toward(shove_->end, arm_of(s), shove_->closed ? kClosedGripper : kOpenGripper,
                             kNearPace);
      case Phase::kClose:
        return servo_.settle(pick_->grasp.tcp, arm_of(s),
                             options_.close ? kClosedGripper : kOpenGripper);
      case Phase::kTransport:
        return follow_path(s, kClosedGripper);
      case Phase::kLower:
        return command_lower(s);
      case Phase::kLift:
        return servo_.toward(place_, arm_of(s), kClosedGripper, kHeldPace);
      case Phase::kKeep:
        return servo_.hold(arm_of(s), kClosedGripper);
      case Phase::kLoosen:
        return command_loosen(s);
      case Phase::kOpen:
        return servo_.hold(arm_of(s), kOpenGripper);
      case Phase::kRetreat: {
        Pose goal = release_;
        goal.position.z() += 0.075;
        return servo_.toward(goal, arm_of(s), kOpenGripper, kHeldPace);
      }
      case Phase::kRest:
        return servo_.hold(arm_of(s), kOpenGripper);
    }
    return servo_.hold(arm_of(s), kOpenGripper);
  }

  policy::Action follow_path(const Scene& s, double gripper) {
    const JointVector next = path_->path.at(++path_step_);
    return servo_.follow(std::span(next.data(), std::size_t(next.size())), arm_of(s), gripper);
  }

  // Opens first: a half-held source must not come along.
  policy::Action command_raise(const Scene& s) {
    if (s.openness < 0.5 && steps_ < 2) return servo_.hold(arm_of(s), kOpenGripper);
    Pose goal = s.tcp;
    goal.position.z() = std::max(goal.position.z(), travel_height(s, s.hand.tip_below));
    return servo_.toward(goal, arm_of(s), kOpenGripper, kHeldPace);
  }

  policy::Action command_lower(const Scene& s) {
    const double gap = gap_to_target(s);
    Pose goal = place_;
    goal.position = carry_goal(s);
    goal.position.z() -= gap;
    return servo_.toward(goal, arm_of(s), kClosedGripper, gap > 0.02 ? kNearPace : kTouchPace);
  }

  // Takes back what the target leads ahead, and opens by a few millimetres so that nothing is
  // flung.
  policy::Action command_loosen(const Scene& s) {
    Pose goal = s.tcp;
    goal.rotation = place_.rotation;
    // Openness is over the fingers' travel; the command's range is a little wider.
    const double gripper = robot::command_of_openness(s.openness + 0.20);
    return servo_.settle(goal, arm_of(s), gripper);
  }

  ExpertOptions options_;
  std::optional<Reach> reach_;
  robot::Law law_;
  double rate_ = 5;         // control steps a second
  int until_decision_ = 0;  // control steps to the next
  int horizon_ = 0;         // control steps
  int steps_left_ = 0;      // decisions

  bool started_ = false;
  Servo servo_;
  Phase phase_ = Phase::kRaise;
  std::vector<policy::Skill> solution_;  // none: the usual pick and place
  std::size_t skill_ = 0;                // of these
  bool skill_begun_ = false;
  JointSkill joint_;
  Pose ready_;                       // of the tool, at the start
  std::optional<PutSpot> put_spot_;  // where a skill puts the source, when that is no object
  bool pushes_ = false;              // the source shall only be pushed
  bool lifts_ = false;               // the source shall only be picked up
  int steps_ = 0;                    // in this phase
  int tries_ = 0;
  std::vector<Pose> failed_;  // grasps, in the source's frame
  Scene last_;
  Recent recent_;
  std::optional<Pick> pick_;
  std::optional<Shove> shove_;
  std::optional<Vec2> spot_;        // where a source goes that shall not lie on the target
  Vec2 first_seen_ = Vec2::Zero();  // centre of the source at the start
  std::optional<PlannedPath> path_;
  int path_step_ = 0;            // of the path, asked for last
  Pose place_;                   // of the tool, where the path ends
  Vec3 in_hand_ = Vec3::Zero();  // the source's origin in the tool's frame when taken
  Pose taken_;
  double taken_bottom_ = 0;
  Pose release_;
};

}  // namespace

Result<std::unique_ptr<policy::Policy>> make_expert(const ExpertOptions& options) {
  if (options.source < 0 ||
      (options.close && (options.target < 0 || options.target == options.source))) {
    return Failure{
        Fault::kPolicy,
        fmt::format("the expert cannot take role {} to role {}", options.source, options.target),
        ""};
  }
  return std::unique_ptr<policy::Policy>(std::make_unique<Expert>(options));
}

}  // namespace probe::expert
