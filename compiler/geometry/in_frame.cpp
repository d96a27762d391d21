#include "compiler/geometry/in_frame.h"

#include <algorithm>
#include <cmath>

namespace probe::sema {
namespace {

Pose pose_of(const std::array<double, 3>& p, const std::array<double, 4>& q) {
  return {{p[0], p[1], p[2]}, Quat(q[0], q[1], q[2], q[3]).normalized()};
}

Quat looking_along(const std::array<double, 4>& direction) {
  const Vec3 forward = Vec3(direction[0], direction[1], direction[2]).normalized();
  const Vec3 left = Vec3::UnitZ().cross(forward).normalized();
  Mat3 axes;
  axes << forward, left, forward.cross(left);
  return Quat(axes);
}

}  // namespace

std::optional<Frustum> Frustum::of(const Model& model, const Scene& scene, const Camera& camera) {
  if (scene.robot == RobotId::kNone || camera.mount_robot != scene.robot || camera.broken)
    return std::nullopt;
  const Robot& robot = model.robots[scene.robot];
  if (!robot.model) return std::nullopt;
  Pose mount;
  for (int link = robot.model->find_link(camera.mount_link.text); link != robot.model->root;) {
    if (link < 0) return std::nullopt;
    const int above = robot.model->links[static_cast<std::size_t>(link)].parent_joint;
    if (above < 0) return std::nullopt;
    const robot::Joint& joint = robot.model->joints[static_cast<std::size_t>(above)];
    if (joint.kind != robot::JointKind::kFixed) return std::nullopt;
    mount = joint.origin * mount;
    link = joint.parent_link;
  }
  Pose aim = pose_of(camera.position, {1, 0, 0, 0});
  const auto& a = camera.aim_values;
  aim.rotation = camera.aim == plan::CameraAim::kLook ? looking_along(a) : pose_of({}, a).rotation;
  Frustum view;
  view.camera_ = &camera;
  view.surface_z_ = scene.surface_z;
  const Pose from_world =
      (pose_of(scene.base_position, scene.base_turn.rotation) * mount * aim).inverse();
  view.turn_from_world_ = from_world.rotation.toRotationMatrix();
  view.world_in_view_ = from_world.position;
  return view;
}

std::optional<double> Frustum::outside(const Object& object, const Start::Placed& placed) const {
  const Mat3 turn = pose_of({}, placed.turn.rotation).rotation.toRotationMatrix();
  const Vec3 low(object.box_min.data()), high(object.box_max.data());
  // Along each of the world's axes every side of the box adds its own least: no corner is needed.
  const Vec3 below = turn.row(2).transpose().cwiseProduct(low);
  const Vec3 above = turn.row(2).transpose().cwiseProduct(high);
  const double lowest = below.cwiseMin(above).sum();
  // A corner is the sum of a part of each axis, of which there are two.
  const Mat3 axes = turn_from_world_ * turn;
  const Vec3 origin =
      world_in_view_ + turn_from_world_ * Vec3(placed.x, placed.y, surface_z_ - lowest);
  const std::array<Vec3, 2> x{origin + axes.col(0) * low.x(), origin + axes.col(0) * high.x()};
  const std::array<Vec3, 2> y{axes.col(1) * low.y(), axes.col(1) * high.y()};
  const std::array<Vec3, 2> z{axes.col(2) * low.z(), axes.col(2) * high.z()};
  double most = 0;
  std::size_t corners_out = 0;
  for (std::size_t i = 0; i < 8; ++i) {
    const Vec3 seen = x[i & 1u] + y[i >> 1u & 1u] + z[i >> 2u];
    if (seen.x() < 1e-3) return std::nullopt;
    const double u = camera_->cx - camera_->fx * seen.y() / seen.x();
    const double v = camera_->cy - camera_->fy * seen.z() / seen.x();
    const double out = std::max({0.0, -u, u - camera_->width, -v, v - camera_->height});
    corners_out += out > 0 ? 1 : 0;
    most = std::max(most, out);
  }
  return corners_out * 2 > 8 ? most : 0;
}

}  // namespace probe::sema
