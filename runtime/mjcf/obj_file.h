// Wavefront OBJ as MuJoCo reads it: corners and faces; materials are the model's, so files that it
// names are not asked for.
#pragma once

#include <string_view>

#include "runtime/base/result.h"
#include "runtime/scene/mesh.h"

namespace probe::mjcf {

// One part; polygons become fans; normals and texture coordinates are left out where a corner has
// none, and v counts from the picture's top. Fails (kAsset, where = NAME:LINE) on a number that is
// none or not finite, a corner that is not there, more than `most_faces` triangles, and no face.
Result<scene::Mesh> read_obj(std::string_view text, std::string_view name, std::size_t most_faces);

}  // namespace probe::mjcf
