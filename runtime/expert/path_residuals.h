// What shapes a path: smoothness, poses on the way, clearance, limits of positions and of moves.
// Weights divide a unit: 1 / (what counts as much as one).
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "runtime/expert/obstacles.h"
#include "runtime/expert/path.h"

namespace probe::expert {

// Weighted backward difference of the joint positions (order 1 to 3) at `step`; rad per step^order.
std::unique_ptr<Residual> difference(int step, int order, double weight);

// The tool at a pose, seen from the base: weights of the position along each axis (1/m) and of the
// rotation vector that is left (1/rad). The chain must outlive the residual, here and below.
struct Via {
  int step = 0;
  Pose pose;
  Vec3 position_weight = Vec3::Zero();
  double rotation_weight = 0;
};
std::unique_ptr<Residual> via(const robot::Chain& chain, const Via& wanted);

// The tool's x axis down: what its horizontal part is off, 1/rad.
std::unique_ptr<Residual> upright(const robot::Chain& chain, int step, double weight);

// Balls that move with the tool, in its frame.
struct Ball {
  Vec3 center = Vec3::Zero();
  double radius = 0;
};
struct Clearance {
  std::vector<StepShare> at;  // one step, or the middle between two
  double margin = 0;          // m wanted between balls and obstacles
  double weight = 0;          // 1/m
};
// One row a ball: what the margin lacks. Balls and obstacles must outlive the residual.
std::unique_ptr<Residual> clearance(const robot::Chain& chain, std::span<const Ball> balls,
                                    const Obstacles& obstacles, const Clearance& wanted);

// What joint positions are within `margin` (rad) of the chain's limits, and beyond; 1/rad.
std::unique_ptr<Residual> joint_limits(const robot::Chain& chain, int step, double margin,
                                       double weight);

// What a joint moves more than `most` (rad) between `step` - 1 and `step`; 1/rad.
std::unique_ptr<Residual> move_limit(int step, double most, double weight);

// The least distance of the balls from the obstacles at the tool's pose, up to `beyond`.
double least_clearance(const Pose& tool, std::span<const Ball> balls, const Obstacles& obstacles,
                       double beyond);

}  // namespace probe::expert
