// The phases of a pick and place. Each decision looks, moves on through phases that are done, and
// asks the servo for one action. The two long moves follow planned paths. A grasp that is lost, or
// a source that is not where it was put in the end, starts it over.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "runtime/expert/path_planner.h"
#include "runtime/expert/put_spot.h"
#include "runtime/expert/servo.h"
#include "runtime/expert/shove.h"
#include "runtime/expert/waypoints.h"

namespace probe::expert {

// What is done with the source.
struct Errand {
  bool close = true;           // false: goes to the source and stays there with open fingers
  bool lifts = false;          // it is only picked up
  bool pushes = false;         // it is only pushed
  bool keeps = false;          // it stays in the hand where it was brought
  bool may_shove = true;       // where there is no hold
  std::vector<PutSpot> spots;  // where it goes when that is no object: one of these
};

// What a decision is made with.
struct Means {
  const policy::Privileged& view;
  const Reach& reach;
  Servo& servo;
  const Recent& recent;  // the arm's last joint positions
  int steps_left = 0;    // decisions
};

class PickPlace {
 public:
  void begin(const Errand& errand, const policy::Privileged& view, const Scene& scene);
  // Keeps still from now on: there is no place for it.
  void rest(std::string lack) {
    enter(Phase::kRest);
    lack_ = std::move(lack);
  }

  policy::Action act(Scene scene, const Means& means);

  // Nothing is left to be done but to keep still.
  bool is_over() const { return phase_ == Phase::kRest || phase_ == Phase::kKeep; }
  // Why it keeps still without having done its errand; empty else.
  std::string lack() const { return phase_ == Phase::kRest ? lack_ : std::string(); }
  // The source is in the air: it hinders the arm no more than an empty hand.
  bool carries() const { return phase_ == Phase::kTransport && steps_ > 1; }

 private:
  enum class Phase {
    kRaise,      // straight up until the fingers clear everything, opening
    kApproach,   // to the grasp, on a planned path
    kShove,      // instead of all that follows, for what cannot be gripped: it is pushed
    kClose,      // still, fingers closing
    kTransport,  // with the source to the place, on a planned path
    kLower,      // until the source rests on the target
    kDrag,       // instead of a transport, for what hangs badly: along the surface that it lies on
    kLift,       // instead of a transport, for what shall only be picked up: straight up
    kKeep,       // instead of all that follows, for what shall stay in the hand: still, closed
    kLoosen,     // fingers just off the source
    kOpen,       // fingers wide
    kRetreat,    // straight up
    kRest,       // still to the end
  };

  void enter(Phase phase);
  void start_over(const Means& means, const char* lack);
  bool holds(const Scene& s) const;
  bool is_put(const Scene& s) const;
  static std::string no_hold(const Scene& s);
  bool moved_since_plan(const Scene& s) const;
  bool lifted_enough(const Scene& s, double rise) const;
  bool path_done() const { return path_step_ >= path_->path.steps(); }
  bool plan_to_grasp(const Scene& s, const Means& means);

  void advance(const Scene& s, const Means& means);
  void advance_raise(const Scene& s, const Means& means);
  void advance_approach(const Scene& s, const Means& means);
  void advance_close(const Scene& s, const Means& means);
  void begin_lift();
  bool is_dragged(const Scene& s) const;
  static double depth_of(const Scene& s);
  void begin_drag(const Scene& s);
  void choose_spot(const Scene& s, const Means& means);
  void begin_transport(Scene s, const Means& means);
  void advance_transport(const Scene& s, const Means& means);
  void advance_lower(const Scene& s, const Means& means);

  // The gripper's command on the way to the source.
  double parted() const;
  // The gripper's command once it has let go.
  double wide() const;
  policy::Action command(const Scene& s, Servo& servo);
  policy::Action follow_path(const Scene& s, Servo& servo, double gripper);
  policy::Action command_raise(const Scene& s, Servo& servo);
  policy::Action command_lower(const Scene& s, Servo& servo);
  policy::Action command_loosen(const Scene& s, Servo& servo);

  Errand errand_;
  Phase phase_ = Phase::kRaise;
  int steps_ = 0;  // in this phase
  int tries_ = 0;
  std::string lack_;          // what ended the last try
  std::vector<Pose> failed_;  // grasps, in the source's frame
  Scene last_;
  std::optional<Pick> pick_;
  std::optional<Shove> shove_;
  Vec2 first_seen_ = Vec2::Zero();  // centre of the source at the start
  std::optional<PlannedPath> path_;
  int path_step_ = 0;            // of the path, asked for last
  std::size_t spot_ = 0;         // of the errand's
  Pose place_;                   // of the tool, where the path ends
  double let_go_ = 1;            // openness there
  Vec3 in_hand_ = Vec3::Zero();  // the source's origin in the tool's frame when taken
  Pose taken_;
  double taken_bottom_ = 0;
  Pose release_;
};

// What the arm measures, as the servo asks for it.
inline Arm arm_of(const Scene& s) { return {s.tcp, s.joints, s.openness}; }

JointVector joints_of(const Scene& s, const Reach& reach);

}  // namespace probe::expert
