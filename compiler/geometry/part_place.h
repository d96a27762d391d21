// Where a part of a fixture is.
#pragma once

#include <optional>
#include <span>

#include "compiler/model/model.h"
#include "runtime/base/geometry.h"
#include "runtime/robot/kinematics.h"

namespace probe::sema {

// The joints of a fixture as a tree; nothing where they make none, which is reported where its
// travel is looked at.
std::optional<robot::Tree> tree_of(const Fixture& fixture);

// Of those of all fixtures of the scene, in its order, the joints of one.
std::span<const double> joints_of(const Model& model, const Scene& scene, FixtureId fixture,
                                  std::span<const double> all);

// Where a fixture's root link stands in a scene.
Pose place_of(const Scene& scene, const Fixture& fixture);

// The frame of a part's link in the world, of a fixture at `place`, its joints (m, rad) there.
Pose part_pose(const Pose& place, const Fixture& fixture, const robot::Tree& tree,
               std::span<const double> joints, std::uint32_t part);

}  // namespace probe::sema
