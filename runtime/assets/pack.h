// One mesh or robot of the user's as a folder that a .probe text can name: what a plan freezes is
// one file a mesh, so textures, materials and buffers are put into it.
#pragma once

#include <string>
#include <vector>

#include "runtime/base/result.h"

namespace probe::assets {

struct PackOptions {
  std::string from;       // .glb, .gltf, .dae, .obj, .stl or .urdf
  std::string to;         // folder to make: ASSETS/objects/NAME, ASSETS/robots/NAME
  std::string collision;  // mesh file; empty: `collision.*` beside `from`, or `from` itself
  double scale = 1;       // 0.001 for millimetres; not for a URDF, which says its own
  std::string up = {};    // "x", "y", "z": which axis of an OBJ or STL points up; empty: z
  bool hollow = false;    // what is felt leaves the inside of a cup free (hollow.h)
  bool refuses_odd_size = false;  // what is no thing of a table's: nobody said a scale
};

struct Packed {
  std::string made;                 // a sentence: size, triangles, convex parts
  std::vector<std::string> doubts;  // what is probably not meant, each with what helps
  std::string text;                 // lines of a .probe text that declare it; empty for a robot
  std::string found = {};           // a sentence: which texts find it; empty for a robot
};

// Fails (kAsset, kUrdf, kIo, kUsage) as the readers do, and when `to` is there already.
Result<Packed> pack_asset(const PackOptions& options);

}  // namespace probe::assets
