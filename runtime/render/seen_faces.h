// What the triangles that a picture shows show anywhere in it: planes of colours, found for those
// alone that are asked for, and the light of their corners, as arrays.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "runtime/render/mipmap.h"
#include "runtime/render/placed_mesh.h"

namespace probe::render {

// How far a step of a pixel goes right and down at depth 1.
struct PixelStep {
  float across = 1, down = 1;
};

// What a triangle shows where the ray (across, down, 1) meets its plane: numerators that are linear
// in across and down, over a denominator that is, too.
struct SeenFace {
  Rgb by_across{}, by_down{}, at_middle{};           // red, green, blue 0 .. 1, and the denominator
  Rgb uv_by_across{}, uv_by_down{}, uv_at_middle{};  // u, v
  // What the three corners' shares come from.
  Rgb edge_by_across{}, edge_by_down{}, edge_at_middle{};
  Rgb mean{};  // colour where the plane is not before the eye
  const MipChain* texture = nullptr;
  float volume = 0;        // depth (m) = volume / denominator
  std::uint32_t id = 0;    // the triangle's number
  std::uint16_t body = 0;  // as segmentation has it
};

// The depth of what a pixel shows: where the triangle's plane has none there, that of its sample.
inline float shown_depth(float depth, const SeenFace& face, float nearness) {
  if (depth > 0 && depth <= std::numeric_limits<float>::max()) return depth;
  return face.id == 0 ? 0 : 1 / nearness;
}

class SeenFaces {
 public:
  static constexpr std::size_t kMost = 2048;

  // Nothing is known any more.
  void begin(const PlacedMeshes& meshes);
  // `id`: a triangle's number, or 0 for nothing. Where it will be. Whether it is known cannot be
  // foreseen, so nothing branches.
  std::uint32_t ask(std::uint32_t id) {
    const std::size_t known = id == 0 ? 0 : slots_[id % kSlots];
    const bool is_known = (known < count_) & (ids_[known] == id);
    const auto slot = static_cast<std::uint32_t>(is_known ? known : count_);
    slots_[id % kSlots] = slot;
    ids_[count_] = id;
    count_ += is_known ? 0 : 1;
    return slot;
  }
  // Finds what was asked for since begin(), kMost at most.
  void find(const PlacedMeshes& meshes);
  const SeenFace& operator[](std::uint32_t slot) const { return faces_[slot]; }

 private:
  // Corners of a part that are lit.
  struct LitPart {
    std::vector<std::uint32_t> corner;
    // x, y, z, of the normal x, y, z, red, green, blue, one after another; then, a row a corner,
    // right, down, forward and nothing, red, green, blue and 1.
    std::vector<float> arrays;
    float* rows() { return arrays.data() + 9 * corner.size(); }
    const float* rows() const { return arrays.data() + 9 * corner.size(); }
  };
  // A triangle that was asked for: its part, its corners there and where these are lit.
  struct Asked {
    std::uint32_t part = 0, triangle = 0;
    std::array<std::uint32_t, 3> corner{}, lit{};
  };
  void light(const PlacedMeshes& meshes, std::uint32_t part);
  void face(const PlacedMeshes& meshes, const Asked& asked, SeenFace& face) const;

  // Where numbers of triangles and corners, by their last digits, were put last: what others took
  // the place of is found once more.
  static constexpr std::size_t kSlots = 1024, kCornerSlots = 4096;
  std::array<std::uint32_t, kSlots> slots_{};
  std::array<std::uint32_t, kCornerSlots> corner_slots_{};
  std::array<std::uint32_t, kMost + 2> ids_{};  // the first is nothing's
  std::size_t count_ = 1;
  std::vector<Asked> asked_;
  std::vector<SeenFace> faces_;
  std::vector<LitPart> lit_;  // by part
  std::vector<std::uint32_t> lit_parts_;
};

}  // namespace probe::render
