// Which objects a fixed camera does not see at the start: the corners of their boxes, projected.
// What hides them from the camera is not known here.
#pragma once

#include <array>
#include <optional>

#include "compiler/model/model.h"
#include "runtime/base/geometry.h"

namespace probe::sema {

class Frustum {
 public:
  // Nothing when the camera moves with the arm or its robot is not known.
  static std::optional<Frustum> of(const Model& model, const Scene& scene, const Camera& camera);

  // How far the farthest corner lies outside the image (px) when more than half of them do, else 0;
  // nothing when a corner is behind the camera. Half may be cut off: the box of a round object has
  // corners where the object has nothing, and a policy still sees it. It stands on the surface.
  std::optional<double> outside(const Object& object, const Start::Placed& placed) const;

 private:
  const Camera* camera_ = nullptr;
  double surface_z_ = 0;
  Mat3 turn_from_world_;  // into forward, left, up
  Vec3 world_in_view_;    // where the world's origin lies there (m)
};

}  // namespace probe::sema
