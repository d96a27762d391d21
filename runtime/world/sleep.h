// What is at rest stops costing anything: when bodies and passive articulations fall asleep, what
// wakes them, and keeping their contacts meanwhile.
#pragma once

#include "runtime/world/bodies.h"
#include "runtime/world/pairs.h"

namespace probe::world {

struct Sleepers {
  std::size_t links = 0;
  std::vector<Articulation>* articulations = nullptr;
  std::vector<Collider>* colliders = nullptr;
  std::vector<Body>* bodies = nullptr;
  PairTable* table = nullptr;
};

// Wakes whatever a moving link or a restless body comes near, until nothing changes. `substep` is
// the present one.
void wake_touched(const Parameters& parameters, std::uint64_t substep, Sleepers* sleepers);
void wake_body(std::size_t body, std::uint64_t substep, Sleepers* sleepers);
void wake_articulation(std::size_t articulation, std::uint64_t substep, Sleepers* sleepers);

// After the poses have moved: counts quiet substeps and puts to sleep.
void fall_asleep(const Problem& problem, const Drives& drives, std::uint64_t substep,
                 Joints* joints, Sleepers* sleepers);

}  // namespace probe::world
