// What the triangles that a picture shows show anywhere in it: planes of colours, found for those
// alone that are asked for, and the light of their corners, as arrays.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "runtime/render/mipmap.h"
#include "runtime/render/placed_mesh.h"

namespace probe::render {

// What a triangle shows where the ray (across, down, 1) meets its plane: numerators that are linear
// in across and down, over a denominator that is, too.
struct SeenFace {
  Rgb by_across{}, by_down{}, at_middle{};           // red, green, blue 0 .. 1, and the denominator
  Rgb uv_by_across{}, uv_by_down{}, uv_at_middle{};  // u, v
  std::array<Rgb, 3>
      edge{};  // what each corner's share comes from: by across, by down, in the middle
  Rgb mean{};  // colour where the plane is not before the eye
  const MipChain* texture = nullptr;
  float volume = 0;        // depth (m) = volume / denominator
  std::uint32_t id = 0;    // the triangle's number
  std::uint16_t body = 0;  // as segmentation has it
};

class SeenFaces {
 public:
  static constexpr std::uint32_t kNothing = 0;  // the place of what shows nothing

  // Nothing is known any more.
  void begin(const PlacedMeshes& meshes);
  // `id`: a triangle's number, or 0 for nothing. Where it will be.
  std::uint32_t ask(std::uint32_t id) {
    if (id == 0) return kNothing;
    std::uint32_t& slot = slots_[id % kSlots];
    if (slot < ids_.size() && ids_[slot] == id) return slot;
    slot = static_cast<std::uint32_t>(ids_.size());
    ids_.push_back(id);
    return slot;
  }
  // Finds what was asked for since begin().
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
  std::vector<std::uint32_t> ids_;
  std::vector<Asked> asked_;
  std::vector<SeenFace> faces_;
  std::vector<LitPart> lit_;  // by part
  std::vector<std::uint32_t> lit_parts_;
};

}  // namespace probe::render
