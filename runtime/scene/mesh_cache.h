// Imported meshes kept on the disk as plain arrays, since decoding pictures and parsing meshes
// takes many times longer than reading them. A cache never changes a result: what is stale, damaged
// or absent is made anew, without a word.
#pragma once

#include <memory>
#include <string>

#include "runtime/base/result.h"
#include "runtime/base/sha256.h"
#include "runtime/scene/mesh.h"
#include "runtime/scene/mesh_import.h"

namespace probe::scene {

// Where meshes are kept, see cache_folder(); empty: nowhere.
std::string default_mesh_cache();

class MeshCache {
 public:
  explicit MeshCache(std::string folder) : folder_(std::move(folder)) {}

  // As load_mesh, which it calls when the cache has nothing of use; then it tries to keep the
  // result. Always reads all source files, since their bytes are the key.
  Result<std::shared_ptr<const Mesh>> load(const std::string& path, const Vec3& scale = {1, 1, 1},
                                           const MeshLimits& limits = {}) const;
  // The file that holds it, whether it is there or not. Fails as load_mesh does on missing sources.
  Result<std::string> file_of(const std::string& path, const Vec3& scale = {1, 1, 1},
                              const MeshLimits& limits = {}) const;

 private:
  std::string folder_;
};

// Through the default cache, and once a process: as long as somebody holds a mesh, its path with
// the same bytes and settings gives the same one.
Result<std::shared_ptr<const Mesh>> shared_mesh(const std::string& path,
                                                const Vec3& scale = {1, 1, 1},
                                                const MeshLimits& limits = {});

}  // namespace probe::scene
