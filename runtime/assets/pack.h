// One mesh or robot of the user's as a folder that a .probe text can name: what a plan freezes is
// one file a mesh, so textures, materials and buffers are put into it.
#pragma once

#include <string>

#include "runtime/base/result.h"

namespace probe::assets {

struct PackOptions {
  std::string from;       // .glb, .gltf, .dae, .obj, .stl or .urdf
  std::string to;         // folder to make: ASSETS/objects/NAME, ASSETS/robots/NAME
  std::string collision;  // mesh file; empty: `collision.*` beside `from`, or `from` itself
  double scale = 1;       // 0.001 for millimetres; not for a URDF, which says its own
};

// A sentence on what was made: size, triangles, convex parts. Fails (kAsset, kUrdf, kIo,
// kUsage) as the readers do, and when `to` is there already.
Result<std::string> pack_asset(const PackOptions& options);

}  // namespace probe::assets
