// Inverse kinematics of a chain: the joint positions near a start that put the chain's link at a
// pose. Levenberg-Marquardt with the joint limits as bounds; Eigen only, fixed order of operations,
// no allocation, so same input gives same bits.
#pragma once

#include <span>

#include "runtime/base/geometry.h"
#include "runtime/robot/kinematics.h"

namespace probe::robot {

struct IkOptions {
  double position_tolerance = 1e-7;  // m
  double rotation_tolerance = 1e-7;  // rad
  int iterations = 100;
  // m that one radian counts as: about an arm's lever, so that both kinds of error fall together.
  // 0: the turn does not matter.
  double lever = 0.3;
};

struct IkResult {
  bool converged = false;
  int iterations = 0;
  double position_error = 0;  // m, at the q returned
  double rotation_error = 0;  // rad
};

// `q` holds the start and receives the best positions found, always within the limits (a start
// outside is moved to the limit first). `target` is in the root link's frame.
IkResult solve_ik(const Chain& chain, const Pose& target, std::span<double> q,
                  const IkOptions& options = {});

}  // namespace probe::robot
