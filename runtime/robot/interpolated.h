// `ee_delta_interpolated`: SimplerEnv's Google robot. Once a control step an action moves the tool
// from where it is measured; inverse kinematics makes joint goals of that, and jerk-limited paths
// lead the drives there, a target before each substep. A path that is longer than the control step
// is cut by the next action. Knows no world and no time.
#pragma once

#include <span>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/robot/action.h"
#include "runtime/robot/control.h"
#include "runtime/robot/jerk_path.h"
#include "runtime/robot/kinematics.h"
#include "runtime/robot/laws.h"

namespace probe::robot {

class InterpolatedController {
 public:
  // Fails (kUrdf) on names that are not there and on limits of a path that are not above 0.
  static Result<InterpolatedController> create(const RobotModel& model, const EeControlSpec& spec,
                                               const EeDeltaInterpolated& law);

  // A new episode at the joint positions q (drive order).
  void reset(std::span<const double> q);

  // A control step of `substeps` begins at measured positions and speeds (drive order). Of the
  // gripper's number, cut to -1 .. 1, all the way between the gripper's two targets is 1: the
  // fingers' goal goes so far on from where they were told to be last, open for a positive one.
  // Fails (kPolicy) on a number that is not finite or beyond 1000 in size; nothing has changed
  // then.
  Status begin(const ToolAction& action, std::span<const double> q, std::span<const double> speeds,
               int substeps);
  // Before each substep: the next sample of the paths, and where the fingers' drives are to be at
  // what speed; the arm's speeds are 0, so that its damping brakes. Both live until the next.
  void next();
  std::span<const double> last() const { return targets_; }          // rad, m
  std::span<const double> target_speeds() const { return speeds_; }  // rad/s, m/s

  // Between control steps.
  ControlState save() const;
  Status restore(const ControlState& state);  // fails (kPolicy) on a robot's with other joints

  const Pose& goal() const { return goal_; }  // of the tool, base frame
  bool reached() const { return reached_; }   // whether joints could have it
  std::span<const double> goal_joints() const { return goal_joints_; }  // of the arm
  std::size_t joint_count() const { return targets_.size(); }

 private:
  InterpolatedController(Chain tool, Chain last) : tool_(std::move(tool)), last_(std::move(last)) {}
  void plan_arm(std::span<const double> q, std::span<const double> speeds);
  void plan_fingers(double command, std::span<const double> q, std::span<const double> speeds);

  EeDeltaInterpolated law_;
  Chain tool_, last_;  // to the tool, and to the link that the arm's last joint carries
  Pose tip_;           // of the tool in that link
  std::vector<double> finger_low_, finger_high_;  // how far goals of fingers may be
  double grip_closed_ = 0, grip_open_ = 0;
  // State.
  std::vector<double> targets_;      // the last sample
  std::vector<double> path_speeds_;  // of the arm, at the last sample
  std::vector<double> finger_goals_;
  Pose goal_;
  bool reached_ = true, fresh_ = true;  // no action since reset()
  // Within a control step.
  std::vector<double> goal_joints_, speeds_;
  std::vector<JerkPath> paths_;  // of all drives
  double sample_ = 0;            // s a substep
  int done_ = 0;
};

// The reference's inverse kinematics: from q, steps of a tenth of damped Gauss-Newton on the
// logarithm of what is left, in the link's own frame, until that is shorter than 1e-4 (m and rad as
// if alike), at most 100. Joint limits are ignored. False leaves q as it was.
bool approach_pose(const Chain& chain, const Pose& goal, std::span<double> q);

}  // namespace probe::robot
