// Instances of meshes under one Embree scene, and what shading must know of each. One thread at a
// time.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "runtime/render/embree_device.h"
#include "runtime/render/mesh_geometry.h"
#include "runtime/render/renderer.h"

namespace probe::render {

struct Instance {
  std::shared_ptr<const MeshGeometry> geometry;
  Pose origin;           // mesh frame in the frame of the visual's pose
  std::uint16_t id = 0;  // what segmentation shows
  bool robot = false;
  std::string name;
  float rotation[9] = {};  // row by row, mesh to world
  float translation[3] = {};
  float camera_in_mesh[3] = {};  // the rays' origin in the mesh frame
};

class TopScene {
 public:
  enum class Kind { kStatic, kDynamic };

  // Loads the ray structures of all meshes. Fails (code "render"), naming the visual, on one
  // without a mesh or with an origin that is not finite.
  static Result<TopScene> create(const std::vector<Visual>& visuals, Kind kind);

  // Poses one a visual (static visuals: identity). Fails on a non-finite pose, naming the visual,
  // before any change.
  Status place(std::span<const Pose> poses, const std::array<float, 3>& camera);

  RTCScene scene() const { return scene_.get(); }
  const std::vector<Instance>& instances() const { return instances_; }
  bool empty() const { return instances_.empty(); }

 private:
  std::shared_ptr<EmbreeDevice> device_;
  std::vector<Instance> instances_;
  std::vector<GeometryPtr> handles_;
  ScenePtr scene_;
};

}  // namespace probe::render
