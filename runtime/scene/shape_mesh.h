// Boxes, spheres and cylinders that a URDF draws, as triangles.
#pragma once

#include "runtime/robot/urdf.h"
#include "runtime/scene/mesh.h"

namespace probe::scene {

// About the shape's own origin, of one material in its colour; 32 corners around what is round.
Mesh shape_mesh(const robot::DrawnPrimitive& drawn);

}  // namespace probe::scene
