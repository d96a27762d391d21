// Reads mesh files (glb, obj, dae, stl) into plain arrays. mesh_import.cpp is the only file that
// includes assimp.
#pragma once

#include <cstddef>
#include <memory>
#include <string>

#include "runtime/base/result.h"
#include "runtime/scene/mesh.h"

namespace probe::scene {

struct MeshLimits {
  std::size_t triangles = 1'000'000;
  // Textures are found relative to the mesh file but never outside this folder; empty: the parent
  // of its folder, so that a mesh can name "../black.png" and no more.
  std::string asset_root{};
};

// Scale is baked into positions (and normals), so that poses stay rigid. Fails (code "asset", where
// = path) on a missing or unreadable file, no triangles or more than the limit, a coordinate that
// is not finite, a texture that is missing, lies outside the asset root or is larger than 16384 a
// side; the message names the texture.
Result<std::shared_ptr<const Mesh>> load_mesh(const std::string& path,
                                              const Vec3& scale = {1, 1, 1},
                                              const MeshLimits& limits = {});

}  // namespace probe::scene
