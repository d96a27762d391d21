// Reads mesh files (glb, gltf, obj, dae, stl) into plain arrays. mesh_import.cpp is the only file
// that includes assimp.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>

#include "runtime/base/result.h"
#include "runtime/scene/mesh.h"

namespace probe::scene {

// Whether it is one of kMeshExtensions.
bool is_mesh_extension(std::string_view extension);  // in lower case, with the dot

struct MeshLimits {
  std::size_t triangles = 1'000'000;
  double extent = 1000;  // m, farthest coordinate from the origin
  // Files that a mesh names are found relative to it but never outside this folder; empty: the
  // parent of its folder, so that a mesh can name "../black.png" and no more.
  std::string asset_root{};
  // Collada's <up_axis>: a Y_UP or X_UP file is turned so that z is up. Off: coordinates as they
  // are written, which is how SAPIEN reads them.
  bool turn_up_axis = true;
  // Refuse a mesh that names other files: a plan freezes one file a mesh.
  bool self_contained = false;
  int cpu_s = 10;  // seconds of computing, after which reading is given up
  // Keep the encoded bytes of the textures in Mesh::encoded, for writing the mesh again.
  bool keep_encoded = false;
};

// Scale, node transforms and Collada's <unit> are baked into positions (and normals), so that poses
// stay rigid and lengths are metres. glTF, OBJ and STL are taken in the axes they are written in.
// Fails (kAsset, where = path) on a missing, unreadable or oversized file, no triangles or
// more than the limit, a coordinate that is not finite or beyond the extent, no size at all, a file
// it names that is missing or lies outside the asset root, a texture above kMaxImageSide, textures
// of more than 96 Mi pixels in all; the
// message names that file. The file is read in a process of its own (runtime/base/apart.h): one that
// makes its reader crash, takes 10 s of computing or 2 GiB is a failure like any other.
Result<std::shared_ptr<const Mesh>> load_mesh(const std::string& path,
                                              const Vec3& scale = {1, 1, 1},
                                              const MeshLimits& limits = {});

}  // namespace probe::scene
