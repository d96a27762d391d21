// The bench's table scene for tests: camera, lights and the arm with its visuals, from any URDF and
// set of meshes.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "runtime/render/renderer.h"
#include "runtime/robot/kinematics.h"
#include "runtime/robot/urdf.h"
#include "runtime/scene/mesh_import.h"
#include "tests/runtime/render/test_scenes.h"

namespace probe::render::test {

inline const std::array<std::string, 8> kArmJoints{"waist",        "shoulder",    "elbow",
                                                   "forearm_roll", "wrist_angle", "wrist_rotate",
                                                   "left_finger",  "right_finger"};
inline const std::array<double, 8> kArmStart{-0.01840777, 0.0398835,  0.22242722, -0.00460194,
                                             1.36524296,  0.00153398, 0.037,      0.037};

inline Pose bench_base() { return {Vec3(0.147, 0.028, 0.870), Quat(0, 0, 0, 1)}; }

inline Camera bench_camera(int width = 640, int height = 480) {
  Camera camera = plain_camera(width, height);
  const Pose base = bench_base();
  camera.position = base.apply(Vec3(0, -0.16, 0.36));
  camera.forward_left_up =
      base.rotation.toRotationMatrix() * look_along(Vec3(1, 0.553, -1.085)).value();
  return camera;
}

// Link visuals of a URDF in order; link_of says whose pose each takes. Bodies 100, 101, ... are the
// links.
struct Arm {
  robot::RobotModel model;
  std::vector<Visual> visuals;
  std::vector<std::size_t> link_of;

  std::vector<Pose> poses(std::span<const double> joints) const {
    const Result<robot::Tree> tree = robot::Tree::create(model, kArmJoints);
    std::vector<Pose> links(model.links.size());
    if (tree) tree->link_poses(joints, links);
    std::vector<Pose> out;
    for (const std::size_t link : link_of) out.push_back(bench_base() * links[link]);
    return out;
  }
};

inline Result<Arm> load_arm(const std::string& urdf) {
  Arm arm;
  PROBE_ASSIGN(arm.model, robot::load_urdf(urdf));
  const std::filesystem::path folder = std::filesystem::path(urdf).parent_path();
  for (std::size_t link = 0; link < arm.model.links.size(); ++link) {
    for (const robot::MeshRef& ref : arm.model.links[link].visuals) {
      PROBE_ASSIGN(auto mesh, scene::load_mesh((folder / ref.path).string(), ref.scale));
      arm.visuals.push_back({.mesh = mesh,
                             .origin = ref.origin,
                             .body = static_cast<std::uint16_t>(100 + link),
                             .name = arm.model.links[link].name,
                             .robot = true});
      arm.link_of.push_back(link);
    }
  }
  return arm;
}

}  // namespace probe::render::test
