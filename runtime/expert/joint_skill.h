// Opens, closes, turns, presses: a part of a fixture is taken, moved along its joint's line or arc
// and let go. What did not move it enough is tried again with another hold.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "runtime/expert/hold_lack.h"
#include "runtime/expert/holds.h"
#include "runtime/expert/reach.h"
#include "runtime/expert/servo.h"

namespace probe::expert {

class JointSkill {
 public:
  // `ready` is where the tool goes behind a hold that was not from above, so that the arm is not
  // left twisted. `only_reaches`: goes to the part and stays there, open.
  void begin(const policy::Skill& skill, const Pose& ready, bool only_reaches = false);

  // One decision; nothing once it is over. `arm.tcp` is the grasp frame in the base frame.
  std::optional<policy::Action> act(const policy::Privileged& view, const Arm& arm, Servo& servo,
                                    const Reach& reach);

  // Whether a part stands as the skill leaves it, so that there is nothing to do.
  static bool is_done(const policy::Skill& skill, const PartJoint& joint) {
    const Goal goal = goal_of(skill, joint);
    return goal.met(joint.position, goal.enough);
  }

  // Whether the joint is where it shall be; after act() gave nothing.
  bool reached() const { return reached_; }
  // Why it is not, then.
  const std::string& lack() const { return lack_; }

 private:
  enum class Phase { kPlan, kHome, kSet, kGo, kMeet, kGrip, kMove, kLetGo, kBack, kOver };
  // Where the joint shall go: done at `enough`, aimed at `aim`, both from `begin` on.
  struct Goal {
    double aim = 0, enough = 0, least = 0;  // `least`: enough where it goes no farther
    bool up = true;
    bool met(double position, double wanted) const {
      return up ? position >= wanted : position <= wanted;
    }
  };
  static Goal goal_of(const policy::Skill& skill, const PartJoint& joint);

  const policy::PrivilegedFixture& part(const policy::Privileged& view) const;
  bool plan(const policy::Privileged& view, const Arm& arm, const Reach& reach);
  bool plan(const policy::Privileged& view, const Arm& arm, const Reach& reach, double aim,
            bool hooks, HoldLack* lack);
  HoldProblem problem_of(const policy::Privileged& view, const Surroundings& around, const Arm& arm,
                         const Reach& reach) const;
  void refine(const policy::Privileged& view, const Arm& arm, const Reach& reach);
  void way_home(const policy::Privileged& view, const Arm& arm, const Reach& reach);
  void way_back(const policy::Privileged& view, const Arm& arm, const Reach& reach);
  void enter(Phase phase);
  void advance(const policy::Privileged& view, const Arm& arm, const Reach& reach);
  policy::Action command(const policy::Privileged& view, const Arm& arm, Servo& servo,
                         const Reach& reach);
  void advance_move(double position);
  // Whether the arm comes from the end of a grip's way to where the tool began.
  bool comes_back(const Arm& arm, const Reach& reach, std::vector<Pose> way) const;
  // Legs of the way back that are near the part.
  std::size_t near_legs() const { return hold_->pushes() ? 2 : 1; }
  void try_again(double position);

  policy::Skill skill_;
  Goal goal_;
  Phase phase_ = Phase::kPlan;
  int steps_ = 0, tries_ = 0, parts_ = 0, homes_ = 0, still_ = 0;
  bool reached_ = false, planned_ = false, only_reaches_ = false, slides_ = false;
  double aim_ = 0;           // of this hold: the goal's, or part of the way there
  double begun_ = 0;         // where the joint was when this hold was planned
  double least_ = 0;         // enough with this hold, where it goes no farther
  bool sets_first_ = false;  // the fingers, before the hand goes to this hold
  double last_ = 0, openness_ = 1;
  Pose ready_;
  Pose at_;  // of the tool, a decision before
  std::optional<Hold> hold_;
  std::vector<Hold> failed_;
  std::string lack_;
  std::vector<Pose> way_;  // of the tool, to the hold or back
  std::size_t next_ = 0;
};

}  // namespace probe::expert
