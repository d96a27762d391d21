// Counts and lengths that a mesh file states, held against what it has. The importer believes some
// of them: it would read beyond arrays, take gigabytes or not come to an end.
#pragma once

#include <string>

#include "runtime/base/result.h"

namespace probe::scene {

// Of a glb, gltf or dae file; other formats count nothing that is believed. Fails (kAsset,
// where = path), naming what does not fit.
Status check_counts(const std::string& path);

}  // namespace probe::scene
