// Constraint rows of contacts and joint limits, and the projected Gauss-Seidel sweeps over them.
// Knows velocities and impulses; nothing of shapes or of time.
#pragma once

#include <vector>

#include "runtime/world/arm_dynamics.h"
#include "runtime/world/drives.h"
#include "runtime/world/state.h"

namespace probe::world {

// What the sweeps work on. Arrays keep their capacity from substep to substep.
struct Problem {
  JointArray u{};
  int joints = 0, lanes = 0;    // of the robot; lanes: padded to a multiple of 4
  std::vector<double> columns;  // of the rows that touch links
  std::vector<Body>* bodies = nullptr;
  std::vector<Contact> contacts;
  std::vector<LimitRow> limits;
};

// Directions, lever arms, the bodies' share of the effective mass and joint columns. Contacts come
// with n, p, gap, bodies and starting impulses filled in.
void build_rows(const Parameters& parameters, const ArmDynamics* arm,
                const std::vector<Collider>& colliders, Problem* problem);

// Rows of joint limits that may be reached within the substep; forgets the impulses of the others.
void build_limits(const Parameters& parameters, const Drives& drives, Joints* joints,
                  Problem* problem);

// The arm's share of the effective masses; again after each change of the drives' saturation.
void couple_arm(const ArmResponse& arm, Problem* problem);

// Takes every impulse back: u and the bodies as they were before warm_start().
void rewind(Problem* problem, const ArmResponse& arm);

// Applies the stored impulses to u and the bodies.
void warm_start(Problem* problem, const ArmResponse& arm);

// Sweeps until the largest velocity change is below the tolerance; returns the number of sweeps.
// Where sweeps run away (see Parameters::runaway) they begin again with friction's bounds held.
int solve(const Parameters& parameters, const ArmResponse& arm, Problem* problem);

}  // namespace probe::world
