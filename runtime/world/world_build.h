// From a spec to the data that the stepper works on, and what is refused on the way.
#pragma once

#include <memory>
#include <vector>

#include "runtime/world/stepper.h"
#include "runtime/world/world.h"

namespace probe::world {

struct BuiltWorld {
  std::unique_ptr<Stepper> stepper;
  std::vector<std::size_t> targets;  // positions of driven articulations
  std::vector<int> urdf_links;       // of the colliders that are links
  std::vector<ExcludedLinks> excluded;
};

// In: a spec. Out: what World::create() completes; bodies have no pose yet. The order: numbers,
// articulations with their links, bodies, fixtures (so that colliders stand in the order that
// Stepper::colliders has), and at last the pairs that may touch. Failures (kWorld) name the thing.
Result<BuiltWorld> build_world(const WorldSpec& spec);

}  // namespace probe::world
