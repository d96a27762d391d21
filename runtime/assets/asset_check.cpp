#include "runtime/assets/asset_check.h"

#include <filesystem>

#include "runtime/scene/collision_mesh.h"
#include "runtime/scene/image.h"

namespace probe::assets {
namespace {

namespace fs = std::filesystem;

// A link is one hull a mesh, whatever its pieces; its scale stands in the URDF and may be a
// thousandth.
Status check_link(const std::string& file, plan::AssetKind kind, scene::MeshLimits limits) {
  limits.extent *= 1000;
  if (kind == plan::AssetKind::kVisualMesh) {
    PROBE_TRY(scene::load_mesh(file, {1, 1, 1}, limits));
    return {};
  }
  PROBE_ASSIGN(const scene::TriangleSoup soup, scene::load_triangles(file, {1, 1, 1}, limits));
  PROBE_TRY(scene::make_collision_shape({soup.vertices}, file));
  return {};
}

Status check_file(const std::string& file, const std::string& path, plan::AssetKind kind,
                  const scene::MeshLimits& limits) {
  const bool is_link = !path.starts_with("objects/") && !path.starts_with("fixtures/") &&
                       !path.starts_with("scenes/");
  switch (kind) {
    case plan::AssetKind::kVisualMesh:
      if (is_link) return check_link(file, kind, limits);
      PROBE_TRY(scene::load_mesh(file, {1, 1, 1}, limits));
      return {};
    case plan::AssetKind::kCollisionMesh:
      if (is_link) return check_link(file, kind, limits);
      PROBE_TRY(scene::load_collision_mesh(file, {1, 1, 1}, limits));
      return {};
    case plan::AssetKind::kPhoto:
      PROBE_TRY(scene::load_image(file));
      return {};
    case plan::AssetKind::kUrdf:
      return {};  // the compiler reads it itself
  }
  return {};
}

}  // namespace

Result<AssetCheck> AssetCheck::open(const AssetRoot& root) {
  AssetCheck check;
  for (const std::string& folder : root.folders()) {
    PROBE_ASSIGN(check.manifests_[folder], read_manifest(folder));
  }
  return check;
}

const Manifest& AssetCheck::manifest(const std::string& folder) const {
  const auto known = manifests_.find(folder);
  if (known != manifests_.end()) return known->second;
  auto read = read_manifest(folder);
  return manifests_[folder] = read ? std::move(*read) : Manifest{};
}

Status AssetCheck::operator()(const std::string& folder, const std::string& path,
                              plan::AssetKind kind, const Sha256& hash) const {
  const fs::path file = fs::path(folder) / path;
  if (const ManifestEntry* entry = manifest(folder).find(path)) {
    std::error_code error;
    const bool same_size = fs::file_size(file, error) == entry->bytes && !error;
    if (same_size && to_hex(hash) == entry->sha256) return {};
  }
  scene::MeshLimits limits;
  limits.asset_root = folder;
  limits.self_contained = true;
  const Status good = check_file(file.string(), path, kind, limits);
  if (good) return {};
  // The path stands before it already; a line number or a texture's name behind it is kept.
  Failure failure = good.failure();
  if (failure.where.starts_with(file.string())) failure.where.erase(0, file.string().size());
  while (!failure.where.empty() && (failure.where[0] == ':' || failure.where[0] == ' ')) {
    failure.where.erase(0, 1);
  }
  return Failure{failure.code, to_text(failure), path};
}

}  // namespace probe::assets
