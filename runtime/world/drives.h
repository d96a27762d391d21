// Joint drives, implicit in the substep: contacts see the arm with its drives already in it. See
// README for the algebra.
#pragma once

#include "runtime/world/state.h"

namespace probe::world {

// Joints as the rows see them: u+ = free_speed + matrix J^T impulse. Articulations do not feel
// each other but through rows: W has a block for each, zero for one that sleeps.
struct JointResponse {
  JointMatrix matrix{};     // W, 1/kg and so on: the inverse of M + dt KD + dt^2 KP
  JointArray free_speed{};  // u*, m/s or rad/s, without contacts
  std::array<int, kMaxJoints>
      saturated{};  // -1, 0, +1: sign of the force limit that replaces the drive
  std::array<bool, kMaxJoints> flung{};  // its force limit is not tried again in this substep
};

// First guess of which drives are at their limit: the torque that the implicit drive would exert on
// the joint's own inertia is beyond it. The torque at the present speed says nothing: after a jump
// of the target a stiff, damped drive reaches its speed within the substep, while a limit force
// without damping would fling a light joint past it. But a drive that ended the last substep at its
// limit and would exceed it at its present speed presses against something: it stays at its limit.
// Otherwise each substep would begin with impulses that belong to another drive, and what is held
// creeps.
// `mass` is of the range's joints, counted from 0.
void guess_saturation(const Drives& drives, const Joints& joints, JointRange range,
                      const JointMatrix& mass, double dt, JointResponse* response);

// W and u* of one articulation for the given saturation: with tau = KP (target - q - dt u+) - KD u+
// and forces f of its own (weight, motion; null: none) acting at the speed after the substep,
//   (M + dt KD + dt^2 KP) u* = M u + dt KP (target - q) + dt f ,
// KP and KD diagonal, M with the joints' armature; a saturated drive gives dt times its limit
// instead. False if the matrix is not positive definite.
bool respond(const Drives& drives, const Joints& joints, JointRange range, const JointMatrix& mass,
             const JointArray* forces, double dt, JointResponse* response);

// Its joints do not move and do not give way.
void hold_still(JointRange range, JointResponse* response);

// Marks drives that exceed their limit at the new speeds `u` and unmarks those whose limit flung
// the joint so far that the drive would already brake; with `release` all that would not reach it.
// True if there are any.
bool find_overload(const Drives& drives, const Joints& joints, JointRange range,
                   const JointArray& u, double dt, bool release, JointResponse* response);

}  // namespace probe::world
