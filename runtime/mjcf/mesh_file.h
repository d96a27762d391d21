// The meshes that a model names, as it means them: moved, turned and scaled.
#pragma once

#include <string>
#include <string_view>

#include "runtime/base/result.h"
#include "runtime/mjcf/model.h"
#include "runtime/scene/mesh.h"
#include "runtime/scene/mesh_import.h"

namespace probe::mjcf {

// MuJoCo's binary mesh: four int32 (vertices, normals, texture coordinates, faces), then float32
// vertices, normals and texture coordinates (v = 0 is the picture's first row), int32 faces;
// little-endian. Normals and texture coordinates are one a vertex or absent. Fails (kAsset, where =
// `name`) on sizes that are not those of the file, an index without a vertex, a number that is not
// finite, more triangles than the limit.
Result<scene::Mesh> msh_mesh(std::string_view bytes, const std::string& name,
                             const scene::MeshLimits& limits = {});

// Reads .msh and .obj here, .stl as scene::load_mesh does; without the file's own materials and
// textures: parts are geometry. What has no normals gets MuJoCo's: the mean of a vertex's faces by
// area, without those that look elsewhere (cosine below 0.8). A mirroring scale turns the triangles
// round. Fails (kAsset, where = the place of the `mesh` element) naming the file.
Result<scene::Mesh> load_mesh_file(const Model& model, const MeshAsset& mesh,
                                   const scene::MeshLimits& limits = {});

}  // namespace probe::mjcf
