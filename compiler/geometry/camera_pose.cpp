#include "compiler/geometry/camera_pose.h"

#include "compiler/geometry/pose.h"

namespace probe::sema {
namespace {

Quat looking_along(const std::array<double, 4>& direction) {
  const Vec3 forward = Vec3(direction[0], direction[1], direction[2]).normalized();
  const Vec3 left = Vec3::UnitZ().cross(forward).normalized();
  Mat3 axes;
  axes << forward, left, forward.cross(left);
  return Quat(axes);
}

}  // namespace

Quat aim_of(const Camera& camera) {
  const auto& a = camera.aim_values;
  const Quat aim =
      camera.aim == plan::CameraAim::kLook ? looking_along(a) : pose_of({}, a).rotation;
  if (camera.turned == std::array<double, 4>{1, 0, 0, 0}) return aim;
  return aim * pose_of({}, camera.turned).rotation;
}

std::optional<Pose> camera_pose(const Model& model, const Scene& scene, const Camera& camera) {
  if (scene.robot == RobotId::kNone || camera.broken)
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
  aim.rotation = aim_of(camera);
  return pose_of(scene.base_position, scene.base_turn.rotation) * mount * aim;
}

}  // namespace probe::sema
