// The WidowX of the assets with the benchmark's drives, for tests of arm and grasp.
#pragma once

#include <filesystem>
#include <string>

#include "runtime/robot/urdf.h"
#include "runtime/scene/hull.h"
#include "runtime/world/world.h"

namespace probe::world {

struct WidowX {
  robot::RobotModel model;
  ArticulationSpec spec;
};

inline std::string widowx_folder() { return VLAPROBE_SOURCE_DIR "/assets/robots/widowx"; }

// Drives and materials: numbers of the reference environment (see assets).
inline Result<std::unique_ptr<WidowX>> load_widowx() {
  auto out = std::make_unique<WidowX>();
  PROBE_ASSIGN(out->model, robot::load_urdf(widowx_folder() + "/wx250s.urdf"));
  ArticulationSpec& arm = out->spec;
  arm.model = &out->model;
  arm.base = {Vec3(0.147, 0.028, 0.870), Quat(0, 0, 0, 1)};
  arm.joints = {{"waist", 1169.789, 330.0, 200},         {"shoulder", 730.0, 180.0, 200},
                {"elbow", 808.460, 152.120, 100},        {"forearm_roll", 1229.130, 309.622, 100},
                {"wrist_angle", 1272.276, 201.050, 100}, {"wrist_rotate", 1056.333, 269.515, 100},
                {"left_finger", 1000, 200, 60},          {"right_finger", 1000, 200, 60}};
  arm.positions = {-0.01840777, 0.0398835,  0.22242722, -0.00460194,
                   1.36524296,  0.00153398, 0.037,      0.037};
  for (const robot::Link& link : out->model.links) {
    if (link.collisions.empty()) continue;
    scene::TriangleSoup all;
    for (const robot::MeshRef& mesh : link.collisions) {
      PROBE_ASSIGN(scene::TriangleSoup soup,
                   scene::load_obj_triangles(widowx_folder() + "/" + mesh.path, mesh.scale));
      for (const std::uint32_t i : soup.indices) {
        all.indices.push_back(i + static_cast<std::uint32_t>(all.vertices.size()));
      }
      for (const Vec3& v : soup.vertices) all.vertices.push_back(mesh.origin.apply(v));
    }
    PROBE_ASSIGN(scene::CollisionShape shape,
                 scene::make_mesh_shape(all, link.name, {.single_hull = true}));
    const bool finger = link.name == "left_finger_link" || link.name == "right_finger_link";
    arm.links.push_back({link.name, std::make_shared<scene::CollisionShape>(std::move(shape)),
                         finger ? 2.0 : 1.0, finger ? 0.01 : 0.0});
  }
  return out;
}

}  // namespace probe::world
