// What a link of a robot or of a fixture fills, as boxes: each of its collision shapes bounded
// along its own axes.
#pragma once

#include <string>
#include <vector>

#include "runtime/robot/urdf.h"
#include "runtime/scene/solid.h"

namespace probe::scene {

// In the link's frame, primitives first. `folder`: of the URDF, which its meshes are named from. A
// mesh that cannot be read fills nothing: whoever loads it for a world says why.
std::vector<Solid> link_solids(const robot::Link& link, const std::string& folder);

}  // namespace probe::scene
