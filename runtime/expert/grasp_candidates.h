// Top-down grasps of an object by two parallel fingers, best first. Works in the robot base frame
// (z up) on footprints and on the gripper's dimensions; whether the arm gets there is another
// file's question.
#pragma once

#include <span>
#include <vector>

#include "runtime/base/geometry.h"
#include "runtime/expert/footprint.h"
#include "runtime/robot/robot.h"

namespace probe::expert {

struct Grasp {
  Pose tcp;               // base frame, fingers around the object
  double yaw = 0;         // turn of the top-down pose about z
  double width = 0;       // of the object between the fingers
  double off_center = 0;  // along the fingers' width, from the object's centre
  double clearance = 0;   // to the nearest other object
  double cost = 0;
  bool rim = false;  // one finger inside the object's outline
  double open = 1;   // how far the fingers are opened before they come; 1: all the way
};

struct GraspProblem {
  const Footprint* source = nullptr;
  std::span<const std::vector<Vec3>> parts;  // its vertices, for rims; may be empty
  std::vector<const Footprint*> others;
  double surface = 0;          // height the fingertips must stay above
  double tip_margin = 0.004;   // m above it, less for flat objects
  double yaw_now = 0;          // of the tool, to prefer short turns
  bool minds_stretch = false;  // of two holds rather the one nearer to the base
  bool narrow = false;         // fingers are set before they come, with little room to the object
  robot::HandShape gripper;
};

// The tool pose at a position with x down, turned by `yaw` about the vertical from
// [[0,0,1],[0,1,0],[-1,0,0]].
Pose top_down(const Vec3& position, double yaw);

// The yaw of the top-down pose nearest to a rotation.
double yaw_of(const Quat& rotation);

// Between each open finger and an object of this width, m.
double side_room(const robot::HandShape& gripper, double width);

// Sorted by cost; empty if nothing fits between the fingers. Several yaws (both ways round) and
// positions.
std::vector<Grasp> grasp_candidates(const GraspProblem& problem);

}  // namespace probe::expert
