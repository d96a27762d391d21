#include "runtime/scene/collision_mesh.h"

#include <array>
#include <filesystem>
#include <map>

#include "runtime/base/asset_path.h"

namespace probe::scene {
namespace {

// Gives each place its number, in the order of first use.
class Welder {
 public:
  void add(const Vec3& p) {
    // + 0.0 turns a negative zero into zero.
    const auto [at, is_new] = places_.try_emplace({p.x() + 0.0, p.y() + 0.0, p.z() + 0.0},
                                                  static_cast<std::uint32_t>(soup.vertices.size()));
    if (is_new) soup.vertices.push_back(p);
    soup.indices.push_back(at->second);
  }
  TriangleSoup soup;

 private:
  std::map<std::array<double, 3>, std::uint32_t> places_;
};

}  // namespace

TriangleSoup weld_triangles(const Mesh& mesh) {
  Welder welder;
  for (const MeshPart& part : mesh.parts) {
    for (const std::uint32_t i : part.indices) {
      const float* p = part.positions.data() + 3 * std::size_t{i};
      welder.add({p[0], p[1], p[2]});
    }
  }
  return std::move(welder.soup);
}

TriangleSoup weld_triangles(const TriangleSoup& soup) {
  Welder welder;
  for (const std::uint32_t i : soup.indices) welder.add(soup.vertices[i]);
  return std::move(welder.soup);
}

Result<TriangleSoup> load_triangles(const std::string& path, const Vec3& scale,
                                    const MeshLimits& limits) {
  if (lower_extension(path) == ".obj") {
    PROBE_ASSIGN(TriangleSoup soup, load_obj_triangles(path, scale));
    const bool keeps_components =
        std::filesystem::path(path).stem().string().find("collision") != std::string::npos;
    return keeps_components ? std::move(soup) : weld_triangles(soup);
  }
  PROBE_ASSIGN(const auto mesh, load_mesh(path, scale, limits));
  return weld_triangles(*mesh);
}

Result<CollisionShape> load_collision_mesh(const std::string& path, const Vec3& scale,
                                           const MeshLimits& limits) {
  PROBE_ASSIGN(const TriangleSoup soup, load_triangles(path, scale, limits));
  PROBE_ASSIGN(CollisionShape shape, make_mesh_shape(soup, path, {.max_vertices = 64}));
  if (shape.parts.size() > kMaxCollisionParts) {
    return Failure{Fault::kAsset,
                   "falls into " + std::to_string(shape.parts.size()) +
                       " separate pieces, at most " + std::to_string(kMaxCollisionParts) +
                       " are taken; a collision.obj of convex parts beside it says what is felt",
                   path};
  }
  return shape;
}

}  // namespace probe::scene
