// One substep after another over the plain data of a world: the order of the stages, nothing else.
#pragma once

#include <vector>

#include "runtime/base/result.h"
#include "runtime/world/bodies.h"
#include "runtime/world/drives.h"
#include "runtime/world/pairs.h"
#include "runtime/world/sleep.h"
#include "runtime/world/sweeps.h"

namespace probe::world {

struct Stepper {
  Parameters parameters;
  Ambient ambient;
  Plane plane;
  Air air;
  bool sleeping = true;
  std::vector<Articulation> articulations;
  Drives drives;
  Joints joints;
  std::vector<Body> bodies;
  std::vector<Collider> colliders;  // links, then bodies, then fixtures
  std::size_t links = 0;
  PairTable table;
  Candidates scratch;
  Problem problem;
  JointResponse response;
  std::uint64_t substep = 1;  // the number of the next substep; records compare with it
  int last_sweeps = 0,
      resolves = 0;       // of the last substep, since the start: for tests and benchmarks
  double drive_load = 0;  // largest share of its limit that a drive gave since it was last zeroed

  Sleepers sleepers() { return {links, &articulations, &colliders, &bodies, &table}; }
  Status advance();

 private:
  void place_awake();
  bool respond_one(const Articulation& articulation);
  bool respond_all();
  bool find_overloads(bool release);
  void free_touched();
  void store_joint_impulses();
  void integrate_all();
  void note_load();
};

}  // namespace probe::world
