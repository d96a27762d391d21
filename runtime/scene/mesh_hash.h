// The content hash of a mesh: what manifests and fingerprints name. A decoder may change, a file
// not.
#pragma once

#include "runtime/base/sha256.h"
#include "runtime/scene/mesh.h"

namespace probe::scene {

// SHA-256 of the decoded little-endian arrays, materials and texels. The name (a path) does not
// count.
Sha256 mesh_hash(const Mesh& mesh);

}  // namespace probe::scene
