// What part of a horizontal plane a camera's picture shows: the picture's frame projected onto it.
#pragma once

#include <vector>

#include "runtime/base/geometry.h"

namespace probe::inspect {

struct Pinhole {
  Vec3 eye = Vec3::Zero();
  Mat3 axes = Mat3::Identity();  // columns forward, left, up in world
  double width = 0, height = 0;  // pixels
  double fx = 0, fy = 0, cx = 0, cy = 0;
};

// Corners on the plane z = height, in the order of the frame's corners; what lies beyond `far`
// metres of height over slope (the horizon) is cut off. Empty when the picture shows nothing of it.
std::vector<Vec3> frame_on_plane(const Pinhole& camera, double plane_z, double far);

}  // namespace probe::inspect
