// One mesh as this program keeps it: a binary glTF with everything embedded to be seen, an OBJ of
// convex parts to be felt. Units, scale, up axis and textures are baked in.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/scene/hull.h"
#include "runtime/scene/mesh.h"
#include "runtime/scene/mesh_import.h"

namespace probe::assets {

inline constexpr char kGenerator[] = "vlaprobe assets import";

struct Extent {
  Vec3 min = Vec3::Zero(), max = Vec3::Zero();
  Vec3 size() const { return max - min; }
};
Extent extent_of(const scene::Mesh& mesh);
Extent extent_of(const scene::TriangleSoup& soup);
std::string size_text(const Vec3& size);  // "11.5 x 3.2 x 3.8 cm"

struct VisualFile {
  std::string glb;
  Extent extent;
  std::size_t triangles = 0;
  int largest_texture = 0;  // pixels of its longer side; 0 without textures
};

// `place` moves and turns the mesh after `scale`. Fails as scene::load_mesh does.
Result<VisualFile> convert_visual(const std::string& path, const Vec3& scale,
                                  const scene::MeshLimits& limits, const std::string& name,
                                  const Pose& place = {});

struct CollisionFile {
  std::string obj;
  Extent extent;
  std::size_t parts = 0;
  // How much of what is felt is not enclosed by the mesh: its hulls fill hollows. 0: not known.
  double filled = 0;
  std::string odd;  // what had to be done about it; empty: nothing
};

// From a collision mesh, or with `from_visual` from the mesh to be seen: then one hull round
// everything where it falls into too many pieces. `hollow`: as split_hollow() leaves it.
Result<CollisionFile> convert_collision(const std::string& path, const Vec3& scale,
                                        const scene::MeshLimits& limits, bool from_visual,
                                        const Pose& place = {}, bool hollow = false);

}  // namespace probe::assets
