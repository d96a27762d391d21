#include "compiler/geometry/in_frame.h"

#include <algorithm>
#include <cmath>

#include "compiler/geometry/camera_pose.h"
#include "compiler/geometry/footprint.h"
#include "compiler/geometry/pose.h"

namespace probe::sema {
std::optional<Frustum> Frustum::of(const Model& model, const Scene& scene, const Camera& camera) {
  const auto pose = camera_pose(model, scene, camera);
  if (!pose) return std::nullopt;
  Frustum view;
  view.camera_ = &camera;
  view.surface_z_ = scene.surface_z;
  const Pose from_world = pose->inverse();
  view.turn_from_world_ = from_world.rotation.toRotationMatrix();
  view.world_in_view_ = from_world.position;
  return view;
}

std::optional<double> Frustum::corner_outside(const Vec3& seen) const {
  if (seen.x() < 1e-3) return std::nullopt;
  const double u = camera_->cx - camera_->fx * seen.y() / seen.x();
  const double v = camera_->cy - camera_->fy * seen.z() / seen.x();
  return std::max({0.0, -u, u - camera_->width, -v, v - camera_->height});
}

std::optional<double> Frustum::outside(std::span<const scene::Solid> boxes) const {
  double most = 0;
  std::size_t corners_out = 0;
  for (const scene::Solid& box : boxes) {
    for (int i = 0; i < 8; ++i) {
      Vec3 corner = box.centre;
      for (int k = 0; k < 3; ++k)
        corner += box.axes[static_cast<std::size_t>(k)] * ((i >> k & 1) != 0 ? 1 : -1);
      const auto out = corner_outside(world_in_view_ + turn_from_world_ * corner);
      if (!out) return std::nullopt;
      corners_out += *out > 0 ? 1 : 0;
      most = std::max(most, *out);
    }
  }
  return corners_out * 2 > 8 * boxes.size() ? most : 0;
}

std::optional<double> Frustum::outside(const Object& object, const Start::Placed& placed) const {
  const Mat3 turn = axes_of(placed.turn);
  const Vec3 low(object.box_min.data()), high(object.box_max.data());
  // A corner is the sum of a part of each axis, of which there are two.
  const Mat3 axes = turn_from_world_ * turn;
  const Vec3 origin = world_in_view_ + turn_from_world_ * Vec3(placed.x, placed.y,
                                                               surface_z_ - lowest(object, turn));
  const std::array<Vec3, 2> x{origin + axes.col(0) * low.x(), origin + axes.col(0) * high.x()};
  const std::array<Vec3, 2> y{axes.col(1) * low.y(), axes.col(1) * high.y()};
  const std::array<Vec3, 2> z{axes.col(2) * low.z(), axes.col(2) * high.z()};
  double most = 0;
  std::size_t corners_out = 0;
  for (std::size_t i = 0; i < 8; ++i) {
    const Vec3 seen = x[i & 1u] + y[i >> 1u & 1u] + z[i >> 2u];
    const auto out = corner_outside(seen);
    if (!out) return std::nullopt;
    corners_out += *out > 0 ? 1 : 0;
    most = std::max(most, *out);
  }
  return corners_out * 2 > 8 ? most : 0;
}

}  // namespace probe::sema
