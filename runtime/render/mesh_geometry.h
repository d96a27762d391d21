// A mesh ready for rays: its committed Embree scene and, per triangle, what a hit needs. Read-only;
// SceneStore shares it.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/render/embree_device.h"
#include "runtime/scene/mesh.h"

namespace probe::render {

// Two cache lines, read in one go by the gather; vectors are read as four floats, so none is last.
struct alignas(64) TriangleData {
  float p0[3], e1[3], e2[3];  // a corner and the edges from it
  float n0[3], n1[3], n2[3];  // corner normals
  float g[3];                 // unit face normal, (P1-P0) x (P2-P0)
  float uv0[2], uv1[2], uv2[2];
};

// That the arrays of a part of `mesh` fit together, and that a texture it names is there and whole.
// Fail (kRender) naming the mesh.
Status check_part(const scene::Mesh& mesh, const scene::MeshPart& part);
Status check_texture(const scene::Mesh& mesh, int index);

struct MeshGeometry {
  struct Part {
    scene::Material material;
    const scene::Texture* base_color = nullptr;  // into mesh->textures
    const scene::Texture* emission = nullptr;
    std::vector<TriangleData> triangles;
    std::vector<float> positions;  // 4 floats longer than its vertices: Embree reads past the last
    std::vector<float> x, y, z;    // positions again, for projection
    float reach = 0;               // the greatest distance of a vertex from the frame's origin
    std::vector<std::uint32_t> indices;
  };

  std::shared_ptr<EmbreeDevice> device;
  std::shared_ptr<const scene::Mesh> mesh;  // keeps textures, and its address names this
  std::vector<Part> parts;                  // geomID is the index
  ScenePtr scene;

  // Fails (kRender) on a mesh whose arrays do not fit together.
  static Result<std::shared_ptr<const MeshGeometry>> build(std::shared_ptr<const scene::Mesh> mesh);
};

}  // namespace probe::render
