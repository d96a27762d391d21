// A mesh as bytes, for a file of the cache and for the way out of the importer's own process;
// little endian as in memory. Reading believes no count before it is held against the bytes there
// are.
#pragma once

#include <functional>
#include <optional>
#include <string_view>

#include "runtime/base/result.h"
#include "runtime/scene/mesh.h"

namespace probe::scene {

// Takes bytes, false when it takes no more.
using ByteSink = std::function<bool(std::string_view)>;

// Materials, parts and textures; neither the name nor the encoded pictures.
bool write_mesh(const Mesh& mesh, const ByteSink& sink);
bool read_mesh(std::string_view bytes, Mesh& mesh);

// What an import came to: a mesh with its encoded pictures, or why there is none.
bool write_import(const Result<Mesh>& mesh, const ByteSink& sink);
std::optional<Result<Mesh>> read_import(std::string_view bytes);

}  // namespace probe::scene
