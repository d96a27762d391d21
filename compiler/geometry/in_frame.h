// Which objects a fixed camera does not see at the start: the corners of their boxes, projected.
// What hides them from the camera is not known here.
#pragma once

#include <array>
#include <optional>
#include <span>

#include "compiler/model/model.h"
#include "runtime/base/geometry.h"
#include "runtime/scene/solid.h"

namespace probe::sema {

class Frustum {
 public:
  // Nothing when the camera moves with the arm or its robot is not known.
  static std::optional<Frustum> of(const Model& model, const Scene& scene, const Camera& camera);

  // How far the farthest corner lies outside the image (px) when more than half of them do, else 0;
  // nothing when a corner is behind the camera. Half may be cut off: the box of a round object has
  // corners where the object has nothing, and a policy still sees it. It stands on the surface.
  std::optional<double> outside(const Object& object, const Start::Placed& placed) const;
  // The same of something that boxes in the world make up.
  std::optional<double> outside(std::span<const scene::Solid> boxes) const;

 private:
  // How far a corner lies outside (px); nothing behind the camera. `seen`: in its frame.
  std::optional<double> corner_outside(const Vec3& seen) const;

  const Camera* camera_ = nullptr;
  double surface_z_ = 0;
  Mat3 turn_from_world_;  // into forward, left, up
  Vec3 world_in_view_;    // where the world's origin lies there (m)
};

}  // namespace probe::sema
