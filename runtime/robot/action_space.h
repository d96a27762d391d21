// What the numbers of a robot's actions are: how many, which of them are lengths, and which action
// asks it to stay. Of `osc_pose` policies give the tool's numbers, and whoever steps the world
// makes shares of them; so there are two spaces, the tool's and that of an arm's joints.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "runtime/robot/action.h"
#include "runtime/robot/laws.h"
#include "runtime/robot/robot.h"

namespace probe::robot {

struct ActionSpace {
  ActionLayout layout = ActionLayout::kShiftTurn;  // or kJointSteps, kJoints
  std::vector<std::string> joints = {};            // of the arm, where the numbers are theirs
  std::vector<bool> slides = {};                   // for each of them

  bool is_of_joints() const { return layout != ActionLayout::kShiftTurn; }
  std::size_t size() const { return is_of_joints() ? joints.size() + 1 : kActionSize; }
  // Whether number i, not the gripper's, is in m; else in rad.
  bool is_length(std::size_t i) const { return is_of_joints() ? slides[i] : i < kActionTurn; }
  // A name for each number: "dx", "dy", "dz", "rx", "ry", "rz", "gripper", or the joints'.
  std::vector<std::string> names() const;
  bool operator==(const ActionSpace&) const = default;
};

ActionSpace action_space_of(const Robot& robot);

// Asks the arm to stay, the gripper as told: no change, or the joints' positions as they are said
// (at least the arm's, drive order; read where numbers are positions alone).
Action standstill(const ActionSpace& space, std::span<const double> joints, double gripper);

}  // namespace probe::robot
