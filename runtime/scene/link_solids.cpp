#include "runtime/scene/link_solids.h"

#include <filesystem>
#include <optional>

#include "runtime/scene/collision_mesh.h"

namespace probe::scene {
namespace {

std::optional<Solid> around_mesh(const robot::MeshRef& ref, const std::string& folder) {
  const auto soup = load_triangles((std::filesystem::path(folder) / ref.path).string(), ref.scale);
  if (!soup.ok() || soup->vertices.empty()) return std::nullopt;
  Vec3 low = soup->vertices.front(), high = low;
  for (const Vec3& v : soup->vertices) {
    low = low.cwiseMin(v);
    high = high.cwiseMax(v);
  }
  return moved(upright_solid(low, high), ref.origin);
}

}  // namespace

std::vector<Solid> link_solids(const robot::Link& link, const std::string& folder) {
  std::vector<Solid> solids;
  for (const robot::Primitive& primitive : link.primitives)
    solids.push_back(moved(upright_solid(-primitive.half, primitive.half), primitive.origin));
  for (const robot::MeshRef& mesh : link.collisions) {
    if (const auto solid = around_mesh(mesh, folder)) solids.push_back(*solid);
  }
  return solids;
}

}  // namespace probe::scene
