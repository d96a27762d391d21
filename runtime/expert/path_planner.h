// Smooth paths of the arm for the two long moves of a pick and place: to the grasp, and with the
// source to the place. The least squares of path.h, filled with what the scene asks for.
#pragma once

#include <optional>
#include <vector>

#include "runtime/expert/obstacles.h"
#include "runtime/expert/path.h"
#include "runtime/expert/path_residuals.h"
#include "runtime/expert/waypoints.h"

namespace probe::expert {

struct PlannedPath {
  Path path;
  double clearance = 0;  // m, least along the path between obstacles and what moves; see beyond
  Fit fit;
};

// The open gripper as balls in the tool's frame; `parted` m is how far the fingers' inner faces are
// from the middle.
std::vector<Ball> gripper_balls(const robot::HandShape& gripper, double parted);

// Extreme points of the source, in the frame of a tool that holds it.
std::vector<Ball> held_balls(const Scene& scene, const Pose& tool);

// All objects but the source, target if asked, fixtures, the surface.
Obstacles obstacles_of(const Scene& scene, bool with_target);

// The steps -2, -1 and 0 of a path.
using Recent = std::vector<JointVector>;

// From where the arm is to the grasp, the last steps straight down. Nothing if the arm cannot.
std::optional<PlannedPath> plan_approach(const Scene& scene, const Reach& reach, const Pick& pick,
                                         const Recent& recent);

// From the grasp, straight up first, to `place`, straight down at last. The source is in the hand;
// `pace` times the usual steps, for holds that are poor.
std::optional<PlannedPath> plan_transport(const Scene& scene, const Reach& reach, const Pose& place,
                                          const Recent& recent, double pace = 1);

}  // namespace probe::expert
