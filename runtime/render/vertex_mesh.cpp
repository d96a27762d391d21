#include "runtime/render/vertex_mesh.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "runtime/render/mesh_geometry.h"
#include "runtime/scene/color.h"

namespace probe::render {
namespace {

// A linear factor as its byte's share of 255: the law works on what files and screens hold.
float display(float linear) {
  const auto& table = scene::kSrgbToLinear;
  const auto above = std::lower_bound(table.begin(), table.end(), linear);
  auto byte = above - table.begin();
  if (above == table.end() || (byte > 0 && linear - *(above - 1) < *above - linear)) --byte;
  return static_cast<float>(byte) / 255.0f;
}

std::array<float, 3> display(const std::array<float, 3>& linear) {
  return {display(linear[0]), display(linear[1]), display(linear[2])};
}

// All of it lies in one plane and looks one way.
bool is_flat(const VertexMesh::Part& part) {
  constexpr float kFlat = 1e-5f;
  const Float3 normal = part.corners[0].normal;
  const float height = normal.dot(part.corners[0].place);
  return std::ranges::all_of(part.corners, [&](const VertexCorner& corner) {
    return (corner.normal - normal).norm() <= kFlat &&
           std::abs(normal.dot(corner.place) - height) <= kFlat;
  });
}

}  // namespace

Result<std::shared_ptr<const VertexMesh>> VertexMesh::build(
    std::shared_ptr<const scene::Mesh> mesh) {
  auto made = std::make_shared<VertexMesh>();
  std::map<int, const MipChain*> textures;
  std::map<float, std::shared_ptr<const PowerTable>> shines;
  for (const scene::MeshPart& from : mesh->parts) {
    PROBE_TRY(check_part(*mesh, from));
    const scene::Material& material = mesh->materials[static_cast<std::size_t>(from.material)];
    PROBE_TRY(check_texture(*mesh, material.base_color_texture));
    Part part;
    const std::size_t corners = from.positions.size() / 3;
    const bool is_textured = material.base_color_texture >= 0 && !from.uv.empty();
    std::array<std::vector<float>, 3> places;
    for (std::size_t i = 0; i < corners; ++i) {
      VertexCorner corner;
      corner.place = {from.positions[3 * i], from.positions[3 * i + 1], from.positions[3 * i + 2]};
      for (std::size_t k = 0; k < 3; ++k) places[k].push_back(from.positions[3 * i + k]);
      const Float3 normal(from.normals[3 * i], from.normals[3 * i + 1], from.normals[3 * i + 2]);
      if (normal.norm() > 0) corner.normal = normal.normalized();
      if (is_textured) corner.uv = {from.uv[2 * i], from.uv[2 * i + 1]};
      part.corners.push_back(corner);
    }
    part.indices = from.indices;
    part.around = ball_around(places[0], places[1], places[2]);
    part.clusters = MeshClusters::build(places[0], places[1], places[2], part.indices);
    part.material.emission = display(material.emission);
    part.material.specular = material.specular;
    auto& shine = shines[material.shininess];
    if (!shine) shine = std::make_shared<const PowerTable>(128.0 * material.shininess);
    part.material.shine = shine;
    if (is_textured) {
      const MipChain*& texture = textures[material.base_color_texture];
      if (texture == nullptr) {
        made->textures.push_back(std::make_unique<const MipChain>(
            mesh->textures[static_cast<std::size_t>(material.base_color_texture)]));
        texture = made->textures.back().get();
      }
      part.texture = texture;
    } else {
      part.material.color = display(material.base_color);
    }
    part.samples = static_cast<int>(std::lround(4 * std::clamp(material.opacity, 0.0f, 1.0f)));
    if (material.metallic > 0 && part.samples == 4 && corners > 0 && is_flat(part))
      part.mirror = material.metallic;
    made->parts.push_back(std::move(part));
  }
  made->mesh = std::move(mesh);
  return std::shared_ptr<const VertexMesh>(std::move(made));
}

}  // namespace probe::render
