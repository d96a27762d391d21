// Skill after skill of a task's solution, or one pick and place where it has none.
#include "runtime/expert/expert.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include <fmt/format.h>

#include "runtime/expert/away.h"
#include "runtime/expert/joint_actions.h"
#include "runtime/expert/joint_skill.h"
#include "runtime/expert/open_first.h"
#include "runtime/expert/pick_place.h"
#include "runtime/expert/put_spot.h"
#include "runtime/expert/put_under.h"
#include "runtime/expert/servo.h"
#include "runtime/expert/tidy_skills.h"
#include "runtime/expert/waypoints.h"
#include "runtime/expert/wrong_skills.h"
#include "runtime/robot/grip_command.h"

namespace probe::expert {
namespace {

constexpr double kHandRoom =
    0.05;                  // m that the fingers may be wide, and a part go between two looks
constexpr int kLooks = 8;  // at a joint's way
constexpr double kDecisionRate = 5;  // a second, of arms that are told their joints
constexpr double kFarther = 0.02;  // of a joint's way: less is open to its end

class Expert final : public policy::Policy {
 public:
  explicit Expert(const ExpertOptions& options) : options_(options) {}

  Status begin(const policy::EpisodeStart& start) override {
    reach_.reset();
    if (start.robot == nullptr) {
      return Failure{Fault::kPolicy, "the expert was told of no robot", ""};
    }
    if (start.delay > 0) return Failure{Fault::kNoSkill, std::string(policy::kLateActions), ""};
    PROBE_ASSIGN(Reach reach, Reach::create(*start.robot));
    reach_ = std::move(reach);
    joint_actions_.reset();
    if (robot::row_of(start.robot->law).per_joint) {
      PROBE_ASSIGN(JointActions made, JointActions::create(*start.robot));
      joint_actions_ = std::move(made);
    }
    horizon_ = start.horizon;
    law_ = start.robot->law;
    rate_ = start.control_hz > 0 ? start.control_hz : 5;
    until_decision_ = 0;
    started_ = false;
    solution_.clear();
    skill_ = 0;
    skill_begun_ = false;
    has_opened_ = goes_under_ = false;
    hand_ = {};
    lack_.clear();
    return {};
  }

  void end(const policy::EpisodeEnd& end) override {
    if (!started_ || !options_.close || !lack_.empty()) return;
    if (!is_all_done()) return note("it was not done when the episode ended");
    // Then the solution does not bring what success asks for, or something else was moved.
    if (end.success || options_.source != 0) return;
    if (solution_.empty()) return note("it was done, but `success` is not true");
    lack_ = "all skills were done, but `success` is not true";
  }
  std::optional<std::string> remark() const override {
    return lack_.empty() ? std::nullopt : std::optional(lack_);
  }

  Result<policy::Action> act(const policy::Observation& observation) override {
    const bool is_first = !started_;
    const std::vector<double>& joints = observation.proprioception.joints;
    if (joint_actions_ && started_ && --until_decision_ > 0) return joint_actions_->go_on(joints);
    PROBE_ASSIGN(const policy::Action step, step_tool(observation));
    if (!joint_actions_) return step;
    if (is_first) joint_actions_->begin(joints);
    return joint_actions_->act(step.tool(), joints);
  }

 private:
  // Control steps between decisions. Ways are planned for drives that have a fifth of a second to
  // follow each step of them: what is told its joints gets that at any rate.
  int interval() const {
    if (!joint_actions_) return servo_.interval();
    return std::max(1, static_cast<int>(std::lround(rate_ / kDecisionRate)));
  }

  // What the tool shall do, in seven numbers.
  Result<policy::Action> step_tool(const policy::Observation& observation) {
    if (!started_ && observation.privileged != nullptr)
      solution_ = skills_of(*observation.privileged);
    // Nothing to do wrong.
    if (options_.source > 1 && solution_.empty() && observation.privileged != nullptr &&
        !observation.privileged->solution.empty())
      return policy::Action{0, 0, 0, 0, 0, 0, kOpenGripper};
    // Nothing to do at all.
    if (!started_ && may_rest(observation)) return policy::Action{0, 0, 0, 0, 0, 0, kOpenGripper};
    PROBE_TRY(check(observation));
    if (started_ && !joint_actions_ && --until_decision_ > 0) {
      const policy::Proprioception& now = observation.proprioception;
      const auto q = std::span(now.joints).first(reach_->chain().joint_count());
      return servo_.next({reach_->chain().pose(q), now.joints, now.openness});
    }
    const policy::Privileged& view = *observation.privileged;
    const Scene scene = seen(observation);
    if (observation.horizon > 0) horizon_ = observation.horizon;
    const Arm arm = arm_of(scene);
    if (!started_) {
      servo_.begin(reach_->chain(), arm, law_, rate_);
      ready_ = arm.tcp;
      started_ = true;
      recent_.assign(Path::kPast, joints_of(scene, *reach_));
      if (solution_.empty()) {
        hand_.begin(usual_errand(view, scene), view, scene);
        usual_ = usual_name(view);
      }
    }
    // Time passes in decisions.
    until_decision_ = interval();
    recent_.erase(recent_.begin());
    recent_.push_back(joints_of(scene, *reach_));
    // A source in the air hinders the arm no more than an empty hand.
    const bool touched =
        std::ranges::any_of(scene.fingers_on_source, [](bool touches) { return touches; });
    servo_.observe(arm, !moves_joint() && (!touched || hand_.carries()));
    const Means means{view, *reach_, servo_, recent_, (horizon_ - observation.step) / interval()};
    const bool may_refuse = observation.step == 0 && options_.close && options_.source == 0;
    if (may_refuse) PROBE_TRY(check_reach(view));
    const policy::Action action =
        solution_.empty() ? hand_.act(scene, means) : act_by_solution(observation, means);
    note_hand();
    // What cannot be begun where the episode begins is not attempted, and no failed start.
    if (may_refuse && !lack_.empty()) return Failure{Fault::kNoSkill, lack_, ""};
    return action;
  }

  // Asked when the episode has ended.
  bool is_all_done() const {
    // The last one keeps still when it is done.
    const bool is_last = skill_ + 1 == solution_.size();
    if (goes_under_ && under_.keeps() && is_last) return true;
    return solution_.empty() || (is_last && !moves_joint()) ? hand_.is_over()
                                                            : skill_ >= solution_.size();
  }

  // What kept a skill from being done; the first is what the others follow from.
  void note(const std::string& lack) {
    if (!lack_.empty() || lack.empty()) return;
    lack_ = (skill_ < solution_.size() ? solution_[skill_].name : usual_) + ": " + lack;
  }
  // The same of what the hand does, if that is what is being done.
  void note_hand() {
    const bool is_hands =
        solution_.empty() || (skill_ < solution_.size() && solution_[skill_].fixture < 0);
    if (is_hands && options_.close) note(hand_.lack());
  }

  // That no skill is about something farther away than the arm is long, wherever its joint stands.
  Status check_reach(const policy::Privileged& view) const {
    for (const policy::Skill& skill : solution_) {
      const Pose to_base = view.base.inverse();
      double beyond = 0;
      if (skill.fixture >= 0) {
        beyond = how_far_beyond(view.fixtures[static_cast<std::size_t>(skill.fixture)], to_base);
      } else if (skill.object >= 0) {
        const policy::PrivilegedObject& object =
            view.objects[static_cast<std::size_t>(skill.object)];
        // What begins in a drawer comes nearer with it.
        if (!std::ranges::any_of(solution_, [](const auto& s) { return s.fixture >= 0; }))
          beyond = beyond_of(object.parts, to_base * object.pose);
      }
      if (beyond <= 0) continue;
      return Failure{
          Fault::kNoSkill,
          fmt::format("{}: it is out of the arm's reach ({:.1f} cm)", skill.name, 100 * beyond),
          ""};
    }
    return {};
  }
  // How far the nearest vertex is beyond what the stretched arm and its hand come to.
  double beyond_of(const std::vector<std::vector<Vec3>>& parts, const Pose& pose) const {
    double least = std::numeric_limits<double>::infinity();
    for (const std::vector<Vec3>& part : parts) {
      double size = 0;  // vertices may be as far apart as the part is large
      for (const Vec3& vertex : part) size = std::max(size, (vertex - part.front()).norm());
      for (const Vec3& vertex : part)
        least = std::min(least, reach_->beyond(pose.apply(vertex)) - size);
    }
    return std::isfinite(least) ? least - reach_->hand().shape.tip_below - kHandRoom : 0;
  }
  double how_far_beyond(const policy::PrivilegedFixture& part, const Pose& to_base) const {
    if (!part.joint || part.joint->endless) return beyond_of(part.parts, to_base * part.pose);
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i <= kLooks; ++i) {
      const double at = part.joint->lower + (part.joint->upper - part.joint->lower) * i / kLooks;
      const Pose pose = moved_part(*part.joint, to_base * part.pose, at - part.joint->position);
      least = std::min(least, beyond_of(part.parts, pose));
    }
    return least;
  }

  // What the skills of a solution are done with, or else the roles.
  Scene seen(const policy::Observation& observation) const {
    const policy::Privileged& view = *observation.privileged;
    Scene scene = look_at(observation, view);
    scene.low_ways = servo_.interval() > 1;
    return scene;
  }
  Scene look_at(const policy::Observation& observation, const policy::Privileged& view) const {
    if (solution_.empty())
      return look(
          observation,
          {view.object_of(options_.source), options_.close ? view.object_of(options_.target) : -1},
          reach_->hand());
    const bool is_over = skill_ >= solution_.size();
    const policy::Skill skill = is_over ? policy::Skill{} : solution_[skill_];
    return look(observation, {skill.object, goes_to_spot(skill) ? -1 : skill.to_object},
                reach_->hand());
  }

  // The skills of this episode; else the usual pick and place.
  std::vector<policy::Skill> skills_of(const policy::Privileged& view) const {
    if (options_.source > 1) return tidied(view, wrong_skills(view, options_.source));
    std::vector<policy::Skill> skills = view.solution;
    // What only reaches goes to the first thing that is done something with.
    if (!options_.close && !skills.empty()) {
      const auto is_left = [&](const policy::Skill& skill) {
        return skill.fixture < 0 ||
               !JointSkill::is_done(skill,
                                    *view.fixtures[static_cast<std::size_t>(skill.fixture)].joint);
      };
      const auto first = std::ranges::find_if(skills, is_left);
      skills = {first == skills.end() ? skills.front() : *first};
    }
    if (options_.close && options_.source == 0) skills = opened_first(view, std::move(skills));
    return tidied(view, std::move(skills));
  }
  bool may_rest(const policy::Observation& observation) const {
    return options_.source == 0 && solution_.empty() && observation.privileged != nullptr &&
           observation.privileged->goal == policy::Goal::kNothing;
  }
  // The skill that is being done.
  bool moves_joint() const {
    return !solution_.empty() && skill_ < solution_.size() && solution_[skill_].fixture >= 0;
  }

  // Without a solution: the source to the target, or what the goal is else.
  Errand usual_errand(const policy::Privileged& view, const Scene& scene) const {
    Errand errand;
    errand.close = options_.close;
    errand.lifts = options_.close && view.goal == policy::Goal::kLifted;
    // Found once: the source must not be led from spot to spot.
    if (options_.close && view.goal == policy::Goal::kAway) {
      if (const auto spot = find_spot(scene, *reach_))
        errand.spots.push_back({-1, -1, {spot->x(), spot->y(), scene.surface}});
      errand.keeps = !errand.spots.empty();
    }
    return errand;
  }

  // What picking and placing is called where no solution says so.
  std::string usual_name(const policy::Privileged& view) const {
    const auto name = [&](int role) {
      const int object = view.object_of(role);
      return object < 0 ? std::string() : view.objects[static_cast<std::size_t>(object)].name;
    };
    const std::string source = name(options_.source), target = name(options_.target);
    const bool is_put = view.goal != policy::Goal::kLifted && !target.empty();
    const char* to = view.goal == policy::Goal::kAway ? "off" : "on";
    return fmt::format("{}`{} {}{}`", policy::kSkillCannot, is_put ? "put" : "pick", source,
                       is_put ? fmt::format(" {} {}", to, target) : "");
  }

  // Skill by skill; one that is done takes no time.
  policy::Action act_by_solution(const policy::Observation& observation, const Means& means) {
    while (skill_ < solution_.size()) {
      const policy::Skill& skill = solution_[skill_];
      const bool is_new = !skill_begun_;
      skill_begun_ = true;
      const Scene scene = seen(observation);
      if (skill.fixture >= 0) {
        if (is_new) joint_.begin(skill, ready_, !options_.close);
        if (const auto action = joint_.act(means.view, arm_of(scene), servo_, *reach_))
          return *action;
        if (!joint_.reached()) note(joint_.lack());
      } else {
        if (is_new && !begin_object_skill(means.view, scene, skill, observation)) {
          skill_begun_ = false;
          continue;
        }
        if (goes_under_) {
          const auto action = under_.act(scene, means.view, *reach_, servo_);
          // What was picked up stays in the hand until the next skill, if there is one.
          const bool goes_on = under_.keeps() && skill_ + 1 < solution_.size();
          if (action && !goes_on) return *action;
          if (options_.close && !goes_on) note(under_.lack());
          ++skill_;
          skill_begun_ = goes_under_ = false;
          continue;
        }
        const policy::Action action = hand_.act(is_new ? seen(observation) : scene, means);
        if (!hand_.is_over() || skill_ + 1 >= solution_.size()) return action;
        note_hand();
      }
      ++skill_;
      skill_begun_ = false;
    }
    // Fingers that turn stand far out to both sides when they are wide: they stay as they are.
    const Arm arm = arm_of(seen(observation));
    const bool turn = !reach_->hand().shape.turning.empty();
    return servo_.hold(arm, turn ? robot::command_of_openness(arm.openness) : kOpenGripper);
  }

  // False: another skill was put before it and comes first.
  bool begin_object_skill(const policy::Privileged& view, const Scene& scene,
                          const policy::Skill& skill, const policy::Observation& observation) {
    using Kind = policy::Skill::Kind;
    Errand errand;
    errand.close = options_.close;
    errand.lifts = skill.kind == Kind::kPick;
    errand.pushes = skill.kind == Kind::kPush;
    // A hand whose fingers turn goes where it points, which is seldom straight down.
    const bool leans = !reach_->hand().shape.turning.empty() &&
                       (skill.kind == Kind::kPick || skill.kind == Kind::kPut);
    goes_under_ = leans && under_.begin(scene, view, skill, *reach_, ready_, !options_.close);
    if (goes_under_) return true;
    const bool needs_spot = options_.close && skill.kind == Kind::kPut && goes_to_spot(skill);
    if (needs_spot)
      errand.spots = find_put_spots(scene, view, skill, *reach_, is_shared(solution_, skill_));
    // Where there is no room beside what lies there already, it goes to the middle, as if alone.
    if (needs_spot && errand.spots.empty() && skill.shares) {
      solution_[skill_].region.reset();
      return begin_object_skill(view, seen(observation), solution_[skill_], observation);
    }
    if (needs_spot && errand.spots.empty() && opens_farther(view, skill)) return false;
    // Where nothing comes from straight above, there may be a way from the side.
    goes_under_ =
        needs_spot && errand.spots.empty() && under_.begin(scene, view, skill, *reach_, ready_);
    if (goes_under_) return true;
    errand.may_shove = errand.spots.empty();
    hand_.begin(errand, view, scene);
    if (needs_spot && errand.spots.empty())
      hand_.rest("there is no spot with room for it that the arm reaches");
    return true;
  }

  // What has no room in a drawer that is nearly open may have in one that is open to its end.
  bool opens_farther(const policy::Privileged& view, const policy::Skill& put) {
    if (put.to_fixture < 0 || has_opened_) return false;
    const auto& joint = view.fixtures[static_cast<std::size_t>(put.to_fixture)].joint;
    if (!joint || joint->endless) return false;
    const double far = joint->closed == joint->upper ? joint->lower : joint->upper;
    const double left = std::abs(far - joint->position);
    if (left < kFarther * std::abs(far - joint->closed)) return false;
    has_opened_ = true;
    policy::Skill open;
    open.kind = policy::Skill::Kind::kOpen;
    open.fixture = put.to_fixture;
    open.fully = true;
    open.name = put.name;
    solution_.insert(solution_.begin() + static_cast<std::ptrdiff_t>(skill_), std::move(open));
    return true;
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
      return Failure{Fault::kNoSkill, std::string(policy::kNoSolution), ""};
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

  ExpertOptions options_;
  std::optional<Reach> reach_;
  robot::Law law_;
  double rate_ = 5;         // control steps a second
  int until_decision_ = 0;  // control steps to the next
  int horizon_ = 0;         // control steps

  bool started_ = false;
  Servo servo_;
  std::optional<JointActions> joint_actions_;  // of an arm that is told its joints
  std::vector<policy::Skill> solution_;        // none: the usual pick and place
  std::size_t skill_ = 0;                      // of these
  bool skill_begun_ = false;
  bool has_opened_ = false;  // farther, for a put
  JointSkill joint_;
  PutUnder under_;
  bool goes_under_ = false;  // that is what puts
  PickPlace hand_;
  std::string usual_;  // the usual pick and place, as a skill is called
  std::string lack_;   // what kept the first skill that was not done from being done
  Pose ready_;         // of the tool, at the start
  Recent recent_;
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
