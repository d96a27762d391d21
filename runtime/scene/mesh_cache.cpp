// PROBE_IMPORT_SOURCES names the importer: its source text and assimp's version (CMakeLists.txt).
// The file: magic, key, size and SHA-256 of the payload, payload; little endian as in memory.
#include "runtime/scene/mesh_cache.h"

#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <map>
#include <mutex>
#include <optional>
#include <span>

#include "runtime/base/cache_folder.h"
#include "runtime/base/file.h"
#include "runtime/scene/mesh_bytes.h"
#include "runtime/scene/mesh_references.h"

namespace probe::scene {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kMagic = "vlaprobe mesh 1\n";

// What was imported, and by what: equal keys, equal meshes.
Result<Sha256> key_of(const std::string& path, const Vec3& scale, const MeshLimits& limits) {
  Hasher hasher;
  hasher.text(kMagic).text(PROBE_IMPORT_SOURCES);
  for (int k = 0; k < 3; ++k) hasher.f64(scale[k]);
  hasher.u64(limits.triangles).f64(limits.extent).u8(limits.turn_up_axis ? 1 : 0);
  // The extension chooses the parser.
  hasher.text(fs::path(path).extension().string());
  const auto feed = [&hasher](const std::string& file) -> Status {
    auto bytes = read_file(file);
    if (!bytes) return Failure{Fault::kAsset, bytes.failure().message, file};
    hasher.text(*bytes);
    return {};
  };
  PROBE_TRY(feed(path));
  PROBE_ASSIGN(const auto references, mesh_references(path, limits.asset_root));
  for (const MeshReference& reference : references) {
    hasher.text(reference.written).text(reference.problem);
    if (reference.path.empty()) continue;
    if (!feed(reference.path)) hasher.text("not there");
  }
  return hasher.finish();
}

struct FileHead {
  char magic[16] = {};
  Sha256 key;
  std::uint64_t size = 0;
  Sha256 checksum;
};

std::shared_ptr<Mesh> read_cached(const std::string& file, const Sha256& key) {
  const auto bytes = read_file(file);
  FileHead head;
  if (!bytes || bytes->size() < sizeof head) return nullptr;
  std::memcpy(&head, bytes->data(), sizeof head);
  const std::string_view payload = std::string_view(*bytes).substr(sizeof head);
  if (std::string_view(head.magic, sizeof head.magic) != kMagic || head.key != key ||
      head.size != payload.size() || head.checksum != sha256(payload)) {
    return nullptr;
  }
  auto mesh = std::make_shared<Mesh>();
  return read_mesh(payload, *mesh) ? mesh : nullptr;
}

// A full disk or a folder that cannot be written costs time, not the mesh.
void try_to_keep(const std::string& file, const Sha256& key, const Mesh& mesh) {
  std::error_code error;
  fs::create_directories(fs::path(file).parent_path(), error);
  if (error) return;
  std::string payload;
  write_mesh(mesh, [&payload](std::string_view bytes) {
    payload += bytes;
    return true;
  });
  FileHead head;
  std::memcpy(head.magic, kMagic.data(), sizeof head.magic);
  head.key = key;
  head.size = payload.size();
  head.checksum = sha256(payload);
  std::string bytes(reinterpret_cast<const char*>(&head), sizeof head);
  bytes += payload;
  static_cast<void>(write_file(file, std::as_bytes(std::span(bytes))).ok());
}

std::string name_in(const std::string& folder, const Sha256& key) {
  return (fs::path(folder) / (to_hex(key) + ".mesh")).string();
}

}  // namespace

std::string default_mesh_cache() { return cache_folder("meshes"); }

Result<std::string> MeshCache::file_of(const std::string& path, const Vec3& scale,
                                       const MeshLimits& limits) const {
  PROBE_ASSIGN(const Sha256 key, key_of(path, scale, limits));
  return name_in(folder_, key);
}

Result<std::shared_ptr<const Mesh>> MeshCache::load(const std::string& path, const Vec3& scale,
                                                    const MeshLimits& limits) const {
  if (folder_.empty() || limits.keep_encoded) return load_mesh(path, scale, limits);
  const auto key = key_of(path, scale, limits);
  if (!key) return load_mesh(path, scale, limits);  // which says it better
  const std::string file = name_in(folder_, *key);
  if (auto mesh = read_cached(file, *key)) {
    mesh->name = path;
    return std::shared_ptr<const Mesh>(std::move(mesh));
  }
  PROBE_ASSIGN(std::shared_ptr<const Mesh> mesh, load_mesh(path, scale, limits));
  try_to_keep(file, *key, *mesh);
  return mesh;
}

Result<std::shared_ptr<const Mesh>> shared_mesh(const std::string& path, const Vec3& scale,
                                                const MeshLimits& limits) {
  static std::mutex mutex;
  static std::map<std::pair<std::string, Sha256>, std::weak_ptr<const Mesh>> known;
  const MeshCache cache(default_mesh_cache());
  const auto key = key_of(path, scale, limits);
  if (!key || limits.keep_encoded) return load_mesh(path, scale, limits);
  const std::scoped_lock lock(mutex);
  std::erase_if(known, [](const auto& entry) { return entry.second.expired(); });
  const auto name = std::pair(path, *key);
  if (const auto found = known.find(name); found != known.end()) {
    if (auto mesh = found->second.lock()) return mesh;
  }
  PROBE_ASSIGN(std::shared_ptr<const Mesh> mesh, cache.load(path, scale, limits));
  known[name] = mesh;
  return mesh;
}

}  // namespace probe::scene
