#include "runtime/render/seen_faces.h"

#include <algorithm>

namespace probe::render {

namespace {

// The two axes that follow, for products across.
inline Rgb next(const Rgb& of) { return __builtin_shufflevector(of, of, 1, 2, 0, 3); }
inline Rgb after(const Rgb& of) { return __builtin_shufflevector(of, of, 2, 0, 1, 3); }

}  // namespace

void SeenFaces::begin(const PlacedMeshes& meshes) {
  slots_.resize(meshes.end_id());
  corner_slots_.resize(meshes.corners());
  lit_.resize(meshes.parts().size());
  for (const std::uint32_t part : lit_parts_) lit_[part].corner.clear();
  lit_parts_.clear();
  ids_.clear();
}

void SeenFaces::find(const PlacedMeshes& meshes) {
  const auto& parts = meshes.parts();
  asked_.resize(ids_.size());
  std::size_t at = 0;  // neighbours in a picture are mostly of one part
  for (std::size_t i = 0; i < ids_.size(); ++i) {
    const std::uint32_t id = ids_[i];
    const auto holds = [&](std::size_t p) {
      return parts[p].first_id <= id && (p + 1 == parts.size() || id < parts[p + 1].first_id);
    };
    if (!holds(at)) {
      const auto after =
          std::ranges::upper_bound(parts, id, {}, &PlacedMeshes::PlacedPart::first_id);
      at = static_cast<std::size_t>(after - parts.begin()) - 1;
    }
    const PlacedMeshes::PlacedPart& placed = parts[at];
    Asked& asked = asked_[i];
    asked.part = static_cast<std::uint32_t>(at);
    asked.triangle = id - placed.first_id;
    LitPart& lit = lit_[at];
    if (lit.corner.empty()) lit_parts_.push_back(asked.part);
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t corner = placed.part->indices[3 * std::size_t{asked.triangle} + k];
      std::uint32_t& slot = corner_slots_[placed.first_corner + corner];
      if (slot >= lit.corner.size() || lit.corner[slot] != corner) {
        slot = static_cast<std::uint32_t>(lit.corner.size());
        lit.corner.push_back(corner);
      }
      asked.corner[k] = corner;
      asked.lit[k] = slot;
    }
  }
  for (const std::uint32_t part : lit_parts_) light(meshes, part);
  faces_.resize(ids_.size());
  for (std::size_t i = 0; i < ids_.size(); ++i) face(meshes, asked_[i], faces_[i]);
}

void SeenFaces::light(const PlacedMeshes& meshes, std::uint32_t at) {
  const PlacedMeshes::PlacedPart& placed = meshes.parts()[at];
  const VertexMesh::Part& part = *placed.part;
  LitPart& lit = lit_[at];
  const std::size_t count = lit.corner.size();
  lit.arrays.resize(9 * count);
  CornerArrays corners{.count = count};
  const std::array<const float*, 3> from{part.x.data(), part.y.data(), part.z.data()};
  for (std::size_t k = 0; k < 3; ++k) {
    float* const position = lit.arrays.data() + k * count;
    float* const normal = lit.arrays.data() + (3 + k) * count;
    for (std::size_t i = 0; i < count; ++i) {
      position[i] = from[k][lit.corner[i]];
      normal[i] = part.normals[3 * std::size_t{lit.corner[i]} + k];
    }
    corners.position[k] = position;
    corners.normal[k] = normal;
    corners.color[k] = lit.arrays.data() + (6 + k) * count;
  }
  meshes.instances()[placed.instance].lamps.light(part.material, corners, part.around);
}

void SeenFaces::face(const PlacedMeshes& meshes, const Asked& asked, SeenFace& face) const {
  const PlacedMeshes::PlacedPart& placed = meshes.parts()[asked.part];
  const VertexMesh::Part& part = *placed.part;
  const PlacedMeshes::Instance& instance = meshes.instances()[placed.instance];
  face.body = instance.body;
  face.texture = part.texture;
  face.mirror = part.mirror;
  const LitPart& lit = lit_[asked.part];
  const std::size_t count = lit.corner.size();
  const float* const red = lit.arrays.data() + 6 * count;
  const auto& m = instance.turn;
  const Rgb by_x{m[0], m[3], m[6], 0}, by_y{m[1], m[4], m[7], 0}, by_z{m[2], m[5], m[8], 0};
  const Rgb shift{instance.shift[0], instance.shift[1], instance.shift[2], 0};
  Rgb corner[3];  // right, down, forward
  for (std::size_t k = 0; k < 3; ++k) {
    const std::uint32_t i = asked.corner[k];
    corner[k] = by_x * part.x[i] + by_y * part.y[i] + by_z * part.z[i] + shift;
  }
  face.by_across = face.by_down = face.at_middle = face.mean = Rgb{};
  face.uv_by_across = face.uv_by_down = face.uv_at_middle = Rgb{};
  for (std::size_t k = 0; k < 3; ++k) {
    const Rgb& a = corner[(k + 1) % 3];
    const Rgb& b = corner[(k + 2) % 3];
    const Rgb edge = next(a) * after(b) - after(a) * next(b);
    face.edge[k] = edge;
    const std::size_t at = asked.lit[k];
    const Rgb color{red[at], red[count + at], red[2 * count + at], 1};
    face.by_across += edge[0] * color;
    face.by_down += edge[1] * color;
    face.at_middle += edge[2] * color;
    face.mean += color * (1.0f / 3);
    if (k == 0) {
      const Rgb product = corner[0] * edge;
      face.volume = product[0] + (product[1] + product[2]);
    }
    if (part.texture == nullptr) continue;
    const float* const from = part.uv.data() + std::size_t{2} * asked.corner[k];
    const Rgb uv{from[0], from[1], 0, 0};
    face.uv_by_across += edge[0] * uv;
    face.uv_by_down += edge[1] * uv;
    face.uv_at_middle += edge[2] * uv;
  }
}

}  // namespace probe::render
