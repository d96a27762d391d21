// Where a camera that does not move with the arm stands and looks.
#pragma once

#include <optional>

#include "compiler/model/model.h"
#include "runtime/base/geometry.h"

namespace probe::sema {

// How the camera is turned in its mount's frame; x looks forward, y left, z up.
Quat aim_of(const Camera& camera);

// Of the camera in the world; x of its frame looks forward, y left, z up. Nothing when the camera
// moves with the arm or its robot is not known.
std::optional<Pose> camera_pose(const Model& model, const Scene& scene, const Camera& camera);

}  // namespace probe::sema
