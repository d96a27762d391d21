// A mesh as the vertex law draws it: corners, parts with what surrounds them, textures at
// falling sizes. Read-only and shared, one a mesh (SceneStore).
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/render/mesh_clusters.h"
#include "runtime/render/mipmap.h"
#include "runtime/render/vertex_law.h"
#include "runtime/scene/mesh.h"

namespace probe::render {

// Whoever needs a corner reads one line of the cache.
struct alignas(32) VertexCorner {
  Float3 place = Float3::Zero();    // m, in the mesh's frame
  Float3 normal = Float3::UnitZ();  // unit
  std::array<float, 2> uv{};        // 0 where there is no texture
};

struct VertexMesh {
  struct Part {
    std::vector<VertexCorner> corners;
    std::vector<std::uint32_t> indices;
    Ball around;
    MeshClusters clusters;  // the same triangles, as they are drawn
    VertexMaterial material;
    const MipChain* texture = nullptr;
    float mirror = 0;  // share of what a flat metal shows of what is before it
    int samples = 4;   // of the four of a pixel that it may have: fewer where it is seen through
  };
  std::shared_ptr<const scene::Mesh> mesh;  // its address names this, and it holds texels
  std::vector<Part> parts;
  std::vector<std::unique_ptr<const MipChain>> textures;

  // Fails (kRender) as MeshGeometry::build does.
  static Result<std::shared_ptr<const VertexMesh>> build(std::shared_ptr<const scene::Mesh> mesh);
};

}  // namespace probe::render
