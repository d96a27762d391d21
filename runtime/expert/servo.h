// From "the tool should go there" to the seven numbers of an action. The controller adds each
// action to a target pose of its own, so the servo keeps the same sum; and joints cover only part
// of the way to a target in a control step, each its own part, so the target is set ahead of where
// the tool shall be next.
#pragma once

#include <array>
#include <optional>
#include <span>

#include "runtime/base/geometry.h"
#include "runtime/expert/drive_response.h"
#include "runtime/expert/tool_tracker.h"
#include "runtime/policy/policy.h"
#include "runtime/robot/kinematics.h"
#include "runtime/robot/laws.h"

namespace probe::expert {

// The seventh number of an action.
inline constexpr double kOpenGripper = 1, kClosedGripper = -1;

struct Pace {
  double shift = 0.05;  // m a control step
  double turn = 0.30;   // rad a control step
  double gain = 0.025;  // m a control step may be longer than the one before: stiff drives follow
                        // jumps at once
  bool lead = true;     // ask for targets beyond, to arrive within the step
};

// What the arm measures.
struct Arm {
  Pose tcp;
  std::span<const double> joints;  // at least the chain's
  double openness = 1;             // of the gripper, 0 .. 1
};

class Servo {
 public:
  // The controller's target at the start of an episode is the tool's pose. The chain must outlive
  // the servo's use.
  void begin(const robot::Chain& chain, const Arm& arm, const robot::Law& law = {},
             double rate = 5);

  // Control steps between decisions: all that is asked for below is for the end of so many. In
  // those between, next() gives the action.
  int interval() const { return tracker_ ? tracker_->interval() : 1; }
  policy::Action next(const Arm& arm);

  // Call once a control step before asking for the action. `free`: nothing was touched, so the
  // joints' moves tell how the drives respond.
  void observe(const Arm& arm, bool free);

  // Moves towards a goal, at most a pace a step. `gripper` is the action's seventh number.
  policy::Action toward(const Pose& goal, const Arm& arm, double gripper, const Pace& pace);

  // Asks for joint positions to be reached within the control step: the next ones of a path.
  policy::Action follow(std::span<const double> joints, const Arm& arm, double gripper);

  // Sets the target to a pose near by, and to nothing beyond it.
  policy::Action settle(const Pose& pose, const Arm& arm, double gripper);

  // Leaves the target where it is.
  policy::Action hold(const Arm& arm, double gripper);

  const Pose& target() const { return target_; }

 private:
  using Joints = std::array<double, robot::kMaxChainJoints>;
  Pose ahead_of(const Pose& next, const Arm& arm) const;
  Pose ahead_of(std::span<const double> next, const Arm& arm) const;
  void correct_target(const Arm& arm);
  policy::Action aim(const Pose& goal, const Arm& arm, double gripper);
  Pose ahead_of_measured(const Pose& goal, const Arm& arm, const Pace& pace) const;
  policy::Action go_to(const Pose& pose, const Arm& arm, double gripper);
  double grip_step(double gripper, double openness);
  policy::Action set_target(const Pose& wanted, const Arm& arm, double gripper);

  const robot::Chain* chain_ = nullptr;
  std::optional<ToolTracker> tracker_;  // under `osc_pose`
  bool from_measured_ = false;          // under `ee_delta_interpolated`
  DriveResponse response_;
  Pose target_;
  Joints joint_target_{}, joints_before_{};
  bool knows_target_ = false;  // joint_target_ is what the controller's inverse kinematics found
  double last_shift_ = 0;
  double last_openness_ = 1;  // under `ee_delta_interpolated`, at the last decision
  bool was_closing_ = false;
  int learnt_ = 0;  // free control steps seen
};

// Whether they are less than `shift` (m) and `turn` (rad) apart.
bool is_near(const Pose& a, const Pose& b, double shift, double turn);

// `from` moved towards `to`, no more than the given shift and turn.
Pose stepped(const Pose& from, const Pose& to, double shift, double turn);

}  // namespace probe::expert
