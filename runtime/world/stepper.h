// One substep after another over the plain data of a world: the order of the stages, nothing else.
#pragma once

#include <memory>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/world/bodies.h"
#include "runtime/world/drives.h"
#include "runtime/world/pairs.h"
#include "runtime/world/sleep.h"

namespace probe::world {

struct Stepper {
  Parameters parameters;
  Ambient ambient;
  Plane plane;
  bool sleeping = true;
  std::unique_ptr<ArmDynamics> arm;  // may be null: a world without a robot
  Drives drives;
  Joints joints;
  std::vector<Body> bodies;
  std::vector<Collider> colliders;  // links, then bodies, then fixtures
  std::size_t links = 0;
  PairTable table;
  Problem problem;
  ArmResponse response;
  std::uint64_t substep = 1;  // the number of the next substep; records compare with it
  int last_sweeps = 0,
      resolves = 0;       // of the last substep, since the start: for tests and benchmarks
  double drive_load = 0;  // largest torque of a drive over its limit since it was last zeroed

  Sleepers sleepers() { return {links, &colliders, &bodies, &table}; }
  Status advance();

 private:
  void note_load();
};

}  // namespace probe::world
