// The control law of the BridgeV2 setting in SimplerEnv ("target delta pose, align2"): seven
// numbers a control step move a target pose of the tool centre point, inverse kinematics turns it
// into joint targets. Knows no world and no time.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "runtime/base/geometry.h"
#include "runtime/base/result.h"
#include "runtime/robot/action.h"
#include "runtime/robot/grip.h"
#include "runtime/robot/ik.h"
#include "runtime/robot/kinematics.h"
#include "runtime/robot/urdf.h"

namespace probe::robot {

// The drive order is: arm joints, then finger joints.
struct EeControlSpec {
  std::string tcp_link;
  std::vector<std::string> arm_joints;     // all that move between the root and the tcp link
  std::vector<std::string> finger_joints;  // all get the same target
  double grip_closed = 0.014;              // m, finger target at gripper = -1
  double grip_open = 0.038;                // m, at +1
};

inline bool opens_up(const EeControlSpec& spec) { return spec.grip_closed <= spec.grip_open; }

// What a controller remembers from one control step to the next, whatever its law.
struct ControlState {
  Pose target;                        // of the tcp link, in the root link's frame; `osc_pose`: goal
  std::vector<double> joint_targets;  // rad and m, drive order; `osc_pose`: the gripper's command,
                                      // and whether no action was yet; `ee_delta_interpolated`:
                                      // interpolated.cpp
  bool reached = true;                // whether the last action had joint positions
};

class EeDeltaPoseController {
 public:
  // Copies what it needs; the model may go. Fails on names that are not there (kUrdf).
  static Result<EeDeltaPoseController> create(const RobotModel& model, const EeControlSpec& spec);

  // A new episode at the joint positions q (drive order): targets are q, the target pose is where
  // the tcp is.
  void reset(std::span<const double> q);

  // The joint targets for an action, given the measured joint positions. The span lives until the
  // next call. The target pose moves even if no joint positions reach it; the arm's targets then
  // stay. Fails (kPolicy) on a number that is not finite or is beyond 1000 in size; nothing has
  // changed then.
  Result<std::span<const double>> targets(const ToolAction& action,
                                          std::span<const double> measured_q);

  std::span<const double> last() const { return joint_targets_; }  // of the last targets()

  ControlState save() const { return {target_, joint_targets_, reached_}; }
  // Goes on from there. Fails (kPolicy) on the state of a robot with other joints.
  Status restore(const ControlState& state);

  // Of the tcp link in the root link's frame.
  const Pose& target_pose() const { return target_; }
  Pose tcp_pose(std::span<const double> q) const;

  // Whether the last call of targets() found joint positions.
  bool reached() const { return reached_; }

  // 0 closed .. 1 open: the mean finger position within the fingers' limits.
  double openness(std::span<const double> q) const;

  std::size_t joint_count() const { return joint_targets_.size(); }

 private:
  explicit EeDeltaPoseController(Chain chain) : chain_(std::move(chain)) {}

  Chain chain_;
  Pose target_;
  std::vector<double> joint_targets_;
  double grip_closed_ = 0, grip_open_ = 0;
  FingerRange range_;
  bool reached_ = true;
};

// One step of the law alone: T' = Trans(p) [R(rotvec), dxyz] Trans(-p) T, with p the measured
// position of the tcp.
Pose moved_target(const Pose& target, const Vec3& measured_position, const Vec3& shift,
                  const Vec3& rotation_vector);

}  // namespace probe::robot
