// What coordinates other than the world's are counted from: the picture of the first camera and the
// robot's base.
#pragma once

#include <optional>

#include "compiler/model/model.h"
#include "runtime/base/geometry.h"

namespace probe::sema {

// A camera that stands still, in the world.
struct Sight {
  Vec3 eye = Vec3::Zero();                                                 // m
  Vec3 right = Vec3::Zero(), down = Vec3::Zero(), forward = Vec3::Zero();  // units
  Vec3 middle = Vec3::Zero();                                              // of the area, m
  Vec3 near = Vec3::Zero();  // along the ground towards who looks, unit
  double depth = 0;          // how far ahead the middle of the scene's area lies, m; positive
};

struct Frame {
  std::optional<Sight> sight;  // nothing when the camera moves, jitters or looks away from the area
  bool jitters = false;        // the camera: why there is no sight
  Vec3 base = Vec3::Zero();    // of the robot, m
  Vec3 ahead = Vec3::Zero(), left = Vec3::Zero();  // of the robot as its base stands, units
};

// `camera` is the first of a task in `scene`.
Frame frame_of(const Model& model, const Scene& scene, const Camera& camera);

}  // namespace probe::sema
