// Projected Gauss-Seidel sweeps over the rows of a substep: impulses, and the velocities that they
// lead to.
#pragma once

#include "runtime/world/rows.h"

namespace probe::world {

// Takes every impulse back: u and the bodies as they were before warm_start().
void rewind(Problem* problem, const JointResponse& response);

// Applies the stored impulses to u and the bodies.
void warm_start(Problem* problem, const JointResponse& response);

// Sweeps until the largest velocity change is below the tolerance; returns the number of sweeps.
// Where sweeps run away (see Parameters::runaway) they begin again with friction's bounds held.
int solve(const Parameters& parameters, const JointResponse& response, Problem* problem);

}  // namespace probe::world
