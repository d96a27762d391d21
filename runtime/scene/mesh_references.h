// The files that a mesh file names: material libraries, textures, buffers. Found in its text
// without decoding anything, so that a plan can name them and a loader is kept to them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "runtime/base/result.h"

namespace probe::scene {

struct MeshReference {
  std::string written;  // as the file names it
  std::string path;     // absolute; empty when it cannot be used
  std::string problem;  // why not
};

// In the order of the text, each file once; those that a material library names included. A
// reference that cannot be used is no failure: Collada files often name pictures that nothing
// shows. Fails (kAsset, where = path) when the mesh file itself cannot be read, is larger
// than kMaxMeshBytes or names more than 1024 files. `root` as MeshLimits::asset_root.
Result<std::vector<MeshReference>> mesh_references(const std::string& path,
                                                   const std::string& root);

// "a%20b" is "a b", as URIs of glTF and Collada write it.
std::string percent_decoded(std::string_view text);

inline constexpr std::size_t kMaxMeshBytes = std::size_t{512} << 20;

// The folder that references of `path` may not leave: `asset_root`, or the parent of its folder.
std::string reference_root(const std::string& path, const std::string& asset_root);

}  // namespace probe::scene
