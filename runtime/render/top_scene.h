// Instances of meshes under one Embree scene, and what shading must know of each. Placing is for
// one thread at a time; a scene that is no longer placed is read-only and may be shared.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "runtime/render/embree_device.h"
#include "runtime/render/instance_set.h"
#include "runtime/render/mesh_geometry.h"
#include "runtime/render/renderer.h"

namespace probe::render {

struct Instance {
  std::shared_ptr<const MeshGeometry> geometry;
  Pose origin;           // mesh frame in the frame of the visual's pose
  std::uint16_t id = 0;  // what segmentation shows
  bool robot = false;
  std::string name;
  // Mesh to world, as Embree was given it, and as it was before rounding.
  float rotation[9] = {};  // row by row
  float translation[3] = {};
  Mat3 exact_rotation = Mat3::Identity();
  Vec3 exact_translation = Vec3::Zero();
  // The rotation's rows and columns again, four floats each, for the loops over hits.
  alignas(16) float rows[3][4] = {}, columns[3][4] = {};
};

class TopScene {
 public:
  enum class Kind { kStatic, kDynamic };

  // `meshes`: one a visual. Fails (kRender), naming the visual, on an origin that is not
  // finite.
  static Result<TopScene> create(const std::vector<Visual>& visuals,
                                 std::vector<std::shared_ptr<const MeshGeometry>> meshes,
                                 Kind kind);

  // Poses one a visual (static visuals: identity). Fails on a non-finite pose, naming the visual,
  // before any change.
  Status place(std::span<const Pose> poses);

  // Those whose transform, as Embree was given it, the last place() changed in any bit.
  InstanceSet moved() const { return moved_; }

  RTCScene scene() const { return scene_.get(); }
  const std::vector<Instance>& instances() const { return instances_; }
  bool empty() const { return instances_.empty(); }

 private:
  std::shared_ptr<EmbreeDevice> device_;
  std::vector<Instance> instances_;
  InstanceSet moved_ = kAllInstances;
  bool placed_ = false;
  std::vector<GeometryPtr> handles_;
  ScenePtr scene_;
};

// A point that rays come from, in the frame of every instance's mesh: what recomputing a hit needs.
// Belongs to a camera, since many look at the same scene.
class RayOrigins {
 public:
  // Gives the instances for which it changed in any bit.
  InstanceSet set(const TopScene& scene, const std::array<float, 3>& point);
  const float* of(std::size_t instance) const { return points_[instance].data(); }

 private:
  std::vector<std::array<float, 4>> points_;
};

}  // namespace probe::render
