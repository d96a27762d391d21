#include "runtime/render/seen_faces.h"

#include <algorithm>

#include "runtime/render/clones.h"
#include "runtime/render/vec4.h"

namespace probe::render {

namespace {

// The two axes that follow, for products across.
inline Rgb next(const Rgb& of) { return __builtin_shufflevector(of, of, 1, 2, 0, 3); }
inline Rgb after(const Rgb& of) { return __builtin_shufflevector(of, of, 2, 0, 1, 3); }

inline void transpose(Rgb (&rows)[4]) {
  const Rgb low_a = __builtin_shufflevector(rows[0], rows[1], 0, 4, 1, 5),
            low_b = __builtin_shufflevector(rows[2], rows[3], 0, 4, 1, 5),
            high_a = __builtin_shufflevector(rows[0], rows[1], 2, 6, 3, 7),
            high_b = __builtin_shufflevector(rows[2], rows[3], 2, 6, 3, 7);
  rows[0] = __builtin_shufflevector(low_a, low_b, 0, 1, 4, 5);
  rows[1] = __builtin_shufflevector(low_a, low_b, 2, 3, 6, 7);
  rows[2] = __builtin_shufflevector(high_a, high_b, 0, 1, 4, 5);
  rows[3] = __builtin_shufflevector(high_a, high_b, 2, 3, 6, 7);
}

// Where corners are as the camera has it, and their colours, a row of eight a corner.
PROBE_CLONES void view_corners(const float* __restrict arrays, std::size_t count,
                               const std::array<float, 9>& turn, const std::array<float, 3>& shift,
                               float* __restrict rows) {
  const std::array<float, 9> m = turn;
  const std::array<float, 3> by = shift;
  const float *x = arrays, *y = arrays + count, *z = arrays + 2 * count;
  const float *red = arrays + 6 * count, *green = arrays + 7 * count, *blue = arrays + 8 * count;
  for (std::size_t i = 0; i < count; ++i) {
    float* const row = rows + 8 * i;
    row[0] = m[0] * x[i] + m[1] * y[i] + m[2] * z[i] + by[0];
    row[1] = m[3] * x[i] + m[4] * y[i] + m[5] * z[i] + by[1];
    row[2] = m[6] * x[i] + m[7] * y[i] + m[8] * z[i] + by[2];
    row[3] = 0;
    row[4] = red[i];
    row[5] = green[i];
    row[6] = blue[i];
    row[7] = 1;
  }
}

}  // namespace

void SeenFaces::begin(const PlacedMeshes& meshes) {
  lit_.resize(meshes.parts().size());
  for (const std::uint32_t part : lit_parts_) lit_[part].corner.clear();
  lit_parts_.clear();
  count_ = 1;
}

void SeenFaces::find(const PlacedMeshes& meshes) {
  const auto& parts = meshes.parts();
  const std::size_t count = count_;
  asked_.resize(count);
  std::size_t at = 0;  // neighbours in a picture are mostly of one part
  for (std::size_t i = 1; i < count; ++i) {
    const std::uint32_t id = ids_[i];
    if (id < parts[at].first_id || id >= parts[at].end_id) at = meshes.part_of(id);
    asked_[i].part = static_cast<std::uint32_t>(at);
    asked_[i].triangle = id - parts[at].first_id;
    __builtin_prefetch(&parts[at].part->indices[3 * std::size_t{asked_[i].triangle}]);
  }
  const std::uint32_t* indices = nullptr;  // of the last one's part
  const VertexCorner* corners = nullptr;
  std::size_t first_corner = 0;
  bool is_shared = false;
  LitPart* lit = nullptr;
  for (std::size_t i = 1; i < count; ++i) {
    Asked& asked = asked_[i];
    if (i == 1 || asked.part != asked_[i - 1].part) {
      const PlacedMeshes::PlacedPart& placed = parts[asked.part];
      indices = placed.part->indices.data();
      corners = placed.part->corners.data();
      first_corner = placed.first_corner;
      is_shared = placed.part->corners.size() < 2 * (placed.part->indices.size() / 3);
      lit = &lit_[asked.part];
      if (lit->corner.empty()) lit_parts_.push_back(asked.part);
    }
    const std::uint32_t* const own = indices + 3 * std::size_t{asked.triangle};
    if (!is_shared) {
      // Each in its turn: most have corners of their own.
      const std::size_t first = lit->corner.size();
      lit->corner.resize(first + 3);
      for (std::size_t k = 0; k < 3; ++k) {
        lit->corner[first + k] = asked.corner[k] = own[k];
        asked.lit[k] = static_cast<std::uint32_t>(first + k);
        __builtin_prefetch(corners + own[k]);
      }
      continue;
    }
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t corner = own[k];
      std::uint32_t& slot = corner_slots_[(first_corner + corner) % kCornerSlots];
      if (slot >= lit->corner.size() || lit->corner[slot] != corner) {
        slot = static_cast<std::uint32_t>(lit->corner.size());
        lit->corner.push_back(corner);
        __builtin_prefetch(corners + corner);
      }
      asked.corner[k] = corner;
      asked.lit[k] = slot;
    }
  }
  for (const std::uint32_t part : lit_parts_) light(meshes, part);
  faces_.resize(std::max(faces_.size(), count));
  faces_[0] = {};
  for (std::size_t i = 1; i < count; ++i) {
    faces_[i].id = ids_[i];
    face(meshes, asked_[i], faces_[i]);
  }
}

void SeenFaces::light(const PlacedMeshes& meshes, std::uint32_t at) {
  const PlacedMeshes::PlacedPart& placed = meshes.parts()[at];
  const VertexMesh::Part& part = *placed.part;
  const PlacedMeshes::Instance& instance = meshes.instances()[placed.instance];
  LitPart& lit = lit_[at];
  const std::size_t count = lit.corner.size();
  lit.arrays.resize(std::max(lit.arrays.size(), 17 * count));
  float* const arrays = lit.arrays.data();
  for (std::size_t i = 0; i < count; ++i) {
    const VertexCorner& corner = part.corners[lit.corner[i]];
    for (std::size_t k = 0; k < 3; ++k) {
      const auto axis = static_cast<Eigen::Index>(k);
      arrays[k * count + i] = corner.place[axis];
      arrays[(3 + k) * count + i] = corner.normal[axis];
    }
  }
  CornerArrays corners{.count = count};
  for (std::size_t k = 0; k < 3; ++k) {
    corners.position[k] = arrays + k * count;
    corners.normal[k] = arrays + (3 + k) * count;
    corners.color[k] = arrays + (6 + k) * count;
  }
  instance.lamps.light(part.material, corners, part.around);
  view_corners(arrays, count, instance.turn, instance.shift, lit.rows());
}

void SeenFaces::face(const PlacedMeshes& meshes, const Asked& asked, SeenFace& face) const {
  const PlacedMeshes::PlacedPart& placed = meshes.parts()[asked.part];
  const VertexMesh::Part& part = *placed.part;
  face.body = meshes.instances()[placed.instance].body;
  face.texture = part.texture;
  const float* const rows = lit_[asked.part].rows();
  Rgb corner[3];  // right, down, forward
  for (std::size_t k = 0; k < 3; ++k) corner[k] = load4(rows + std::size_t{8} * asked.lit[k]);
  Rgb by_across{}, by_down{}, at_middle{}, mean{};
  Rgb edges[4]{};
  Rgb uv_by_across{}, uv_by_down{}, uv_at_middle{};
  for (std::size_t k = 0; k < 3; ++k) {
    const Rgb& a = corner[(k + 1) % 3];
    const Rgb& b = corner[(k + 2) % 3];
    const Rgb edge = next(a) * after(b) - after(a) * next(b);
    edges[k] = edge;
    const Rgb color = load4(rows + std::size_t{8} * asked.lit[k] + 4);
    by_across += edge[0] * color;
    by_down += edge[1] * color;
    at_middle += edge[2] * color;
    mean += color * (1.0f / 3);
    if (k == 0) {
      const Rgb product = corner[0] * edge;
      face.volume = product[0] + (product[1] + product[2]);
    }
    if (part.texture == nullptr) continue;
    const auto& from = part.corners[asked.corner[k]].uv;
    const Rgb uv{from[0], from[1], 0, 0};
    uv_by_across += edge[0] * uv;
    uv_by_down += edge[1] * uv;
    uv_at_middle += edge[2] * uv;
  }
  transpose(edges);
  face.edge_by_across = edges[0];
  face.edge_by_down = edges[1];
  face.edge_at_middle = edges[2];
  face.by_across = by_across;
  face.by_down = by_down;
  face.at_middle = at_middle;
  face.mean = mean;
  face.uv_by_across = uv_by_across;
  face.uv_by_down = uv_by_down;
  face.uv_at_middle = uv_at_middle;
}

}  // namespace probe::render
