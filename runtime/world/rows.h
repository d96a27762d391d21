// Constraint rows of contacts and joints: directions, lever arms, joint columns, effective masses.
// Knows velocities and impulses; nothing of shapes or of time. sweeps.h solves them.
#pragma once

#include <vector>

#include "runtime/world/articulation.h"
#include "runtime/world/drives.h"
#include "runtime/world/state.h"

namespace probe::world {

// What the sweeps work on. Arrays keep their capacity from substep to substep.
struct Problem {
  JointArray u{};               // m/s, rad/s
  int joints = 0, lanes = 0;    // of the world; lanes: padded to a multiple of 4
  std::vector<double> columns;  // of the rows that touch links
  std::vector<Body>* bodies = nullptr;
  std::vector<Contact> contacts;
  std::vector<ContactRows> rows;  // one a contact
  std::vector<LimitRow> limits;
  std::vector<JointFrictionRow> joint_frictions;
};

// Directions, lever arms, the bodies' share of the effective mass and joint columns. Contacts come
// with n, p, gap, tangents, bodies, paths and starting impulses filled in.
void build_rows(const Parameters& parameters, const std::vector<Articulation>& articulations,
                const std::vector<Collider>& colliders, Problem* problem);

// Rows of joint limits that may be reached within the substep, and of joint friction; forgets the
// impulses of the other limits. Joints of an articulation that sleeps have none.
void build_joint_rows(const Parameters& parameters, const Drives& drives,
                      const std::vector<Articulation>& articulations, Joints* joints,
                      Problem* problem);

// The joints' share of the effective masses; again after each change of the drives' saturation.
void couple_joints(const JointResponse& response, Problem* problem);

}  // namespace probe::world
