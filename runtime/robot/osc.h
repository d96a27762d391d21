// `osc_pose`: robosuite's operational space control. Once a control step an action moves a goal
// pose away from where the tool is; before each substep a wrench towards the goal, weighed with the
// inertia that the tool has, becomes torques of the arm's joints. Knows no world and no time.
#pragma once

#include <span>
#include <vector>

#include "runtime/base/geometry.h"
#include "runtime/base/result.h"
#include "runtime/robot/control.h"
#include "runtime/robot/dynamics.h"
#include "runtime/robot/laws.h"

namespace probe::robot {

class OscPoseController {
 public:
  // Torques are clipped to the law's limits, or the description's efforts. Fails (kUrdf) on names
  // that are not there, on a law whose numbers no controller can have and on a `home` that has not
  // one position for each arm joint.
  static Result<OscPoseController> create(const RobotModel& model, const EeControlSpec& spec,
                                          OscPose law);

  // A new episode: the goal is the tool's pose at `home`, wherever the joints are (robosuite's
  // reset adds its noise after it has set the goal), and the gripper's command is the middle.
  void reset();

  // The action of a control step of `substeps`: six shares of the law's output, gripper -1 opens,
  // +1 closes, 0 stays. Fails (kPolicy) on a number that is not finite or beyond 1000 in size;
  // nothing has changed then.
  Status begin(std::span<const double> action, int substeps);

  // What the next efforts() is to be given in place of what is: the arm at these positions, at
  // rest. Empty but in the first substep after reset(). robosuite reads its robot at the end of a
  // substep, so in the first it still has what it read at its reset, wherever noise or a stored
  // state has put the joints since.
  std::span<const double> believed() const {
    return fresh_ ? std::span<const double>(law_.home) : std::span<const double>();
  }

  // Before each substep: N m and N of the arm's joints, then of the fingers'. The first call after
  // begin() sets the goal, from where the tool is then.
  void efforts(const Dynamics& now, std::span<double> out);

  ControlState save() const { return {goal_, {opening_, fresh_ ? 1.0 : 0.0}, true}; }
  Status restore(const ControlState& state);  // fails (kPolicy) on a state of another law

  const Pose& goal() const { return goal_; }        // of the tool, base frame
  double grip_command() const { return opening_; }  // -1 closed .. +1 open
  std::size_t joint_count() const { return arm_ + fingers_.size(); }

 private:
  struct Finger {
    double middle = 0, half = 0;  // m, of the way from closed to open
  };
  void set_goal(const Dynamics& now);
  Pose wanted();
  void arm_efforts(const Dynamics& now, const Pose& goal, std::span<double> out) const;

  OscPose law_;
  std::array<double, 6> kd_{};  // 1/s
  std::vector<double> limits_;  // N m, of the arm's joints
  std::vector<Finger> fingers_;
  std::size_t arm_ = 0;
  Pose home_;  // of the tool at law_.home
  // State.
  Pose goal_;
  double opening_ = 0;
  bool fresh_ = true;  // no substep since reset()
  // Within a control step.
  std::array<double, 6> delta_{};  // m, rad
  double grip_ = 0;                // sign of the gripper's number
  bool pending_ = false;           // the goal is yet to be set
  Pose start_;                     // the goal before this step's
  int ramp_ = 0, ramped_ = 0;      // substeps of the ramp, and those done
};

// An action in m and rad, gripper -1 closes .. +1 opens (action.h), as begin() wants it: shares of
// the law's output, and the gripper's sign the other way round.
ToolAction shares_of(const OscPose& law, const ToolAction& action);

// 0.5 (r1 x g1 + r2 x g2 + r3 x g3) with the columns of both: robosuite's orientation error, world
// axes; near the goal it is the rotation vector that is left.
Vec3 rotation_error(const Mat3& from, const Mat3& to);

}  // namespace probe::robot
