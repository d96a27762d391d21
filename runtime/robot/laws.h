// Control laws as data: one struct a kind, and one table of the kinds. A law turns the numbers of
// an action into what drives joints; the classes that do so are control.h's (`ee_delta_pose`),
// osc.h's, joint_control.h's and interpolated.h's, and controller.h's is whichever a robot has.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "runtime/robot/jerk_path.h"

namespace probe::robot {

// The BridgeV2 setting's: a target pose that moves, inverse kinematics, drives with targets. Its
// numbers are the robot's drives and the two places of the fingers (EeControlSpec).
struct EeDeltaPose {};

// How robosuite's grippers follow: the command is a sign, what it asks for moves at a fixed pace.
struct SignGrip {
  double pace = 0.01;       // of half the range, a substep
  double stiffness = 1000;  // N/m: force = stiffness (asked for - q), within
  double limit = 20;        // N
};

// robosuite 1.4.1's OSC_POSE (controllers/osc.py, config/osc_pose.json): a wrench at the tool that
// draws it to a goal pose, by the inertia that the tool has, and torques that make it. Numbers as
// LIBERO uses them.
struct OscPose {
  std::array<double, 6> kp{150, 150, 150, 150, 150, 150};  // 1/s2: x y z, then about x y z
  std::array<double, 6> damping{1, 1, 1, 1, 1, 1};         // kd = 2 sqrt(kp) damping, 1/s
  // What an action of 1 asks for: m and rad. Actions are clipped to +-1.
  std::array<double, 6> output{0.05, 0.05, 0.05, 0.5, 0.5, 0.5};
  double null_kp = 10;   // 1/s2, of the joints towards `home` where the tool does not feel it
  bool uncouple = true;  // shift and turn each by its own inertia, as if the other were free
  // Share of a control step in which the goal goes from the last one to the new one; 0: at once.
  double ramp = 0;
  // rad, of the arm's joints: where the null space draws them, and where the tool's rotation is the
  // first goal.
  std::vector<double> home;
  // N m, of the arm's joints: torques are clipped to these; empty: to the description's efforts.
  std::vector<double> limits;
  SignGrip grip;
};

// Joint targets from joint steps, rad or m: of the last target, or of the measured position.
struct JointDelta {
  bool from_target = true;
  double most = 0;  // rad or m, steps are clipped to it; 0: they are not
};

// Joint targets as they are, rad or m.
struct JointPosition {};

// SimplerEnv's Google robot: a target pose from where the tool is, and jerk-limited paths of the
// joints to it, all of the arm ended together, the fingers' as well (interpolated.h).
struct EeDeltaInterpolated {
  PathLimits arm{1.5, 2.0, 50.0};
  PathLimits fingers{1.0, 7.0, 50.0};
  double period = 1.0 / 3;  // s, a control step
};

using Law = std::variant<EeDeltaPose, OscPose, JointDelta, JointPosition, EeDeltaInterpolated>;

// A row for each alternative of Law, in its order.
enum class ControlKind : std::uint8_t {
  kEeDeltaPose,
  kOscPose,
  kJointDelta,
  kJointPosition,
  kEeDeltaInterpolated
};

// What the numbers of an action are. The gripper's is the last.
enum class ActionLayout : std::uint8_t {
  kShiftTurn,   // action.h: m, rotation vector in rad, gripper -1 closed .. +1 open
  kShares,      // the same six in shares of the law's output, -1 .. 1; gripper -1 opens, +1 closes
  kJointSteps,  // one of each arm joint, rad or m; gripper -1 closed .. +1 open
  kJoints,      // the same, positions
};

// What a law reads of the world.
enum class Reads : std::uint8_t {
  kPositions,  // joint positions, once a control step; it gives targets of drives
  kStates,     // positions and speeds, once a control step; it gives targets before each substep
  kDynamics,   // Dynamics, before each substep; it gives efforts (world: by_efforts)
};

struct KindRow {
  ControlKind kind = ControlKind::kEeDeltaPose;
  std::string_view word;  // in a text
  ActionLayout layout = ActionLayout::kShiftTurn;
  std::size_t fixed = 0;   // numbers of an action,
  bool per_joint = false;  // and one more for each arm joint
  Reads reads = Reads::kPositions;

  std::size_t action_size(std::size_t arm_joints) const {
    return fixed + (per_joint ? arm_joints : 0);
  }
};

std::span<const KindRow> control_kinds();
const KindRow& row_of(const Law& law);
const KindRow* find_kind(std::string_view word);  // null if there is none
std::string known_kinds();                        // "`ee_delta_pose`, `osc_pose`, ..."

}  // namespace probe::robot
