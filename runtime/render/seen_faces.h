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
  float volume = 0;  // depth (m) = volume / denominator
  float mirror = 0;
  std::uint16_t body = 0;  // as segmentation has it
};

class SeenFaces {
 public:
  // Nothing is known any more.
  void begin(const PlacedMeshes& meshes);
  // `id`: a triangle's number, from 1 on.
  void ask(std::uint32_t id) {
    std::uint32_t& slot = slots_[id];
    if (slot < ids_.size() && ids_[slot] == id) return;
    slot = static_cast<std::uint32_t>(ids_.size());
    ids_.push_back(id);
  }
  // Finds what was asked for since begin().
  void find(const PlacedMeshes& meshes);
  std::size_t size() const { return ids_.size(); }
  const SeenFace& at(std::uint32_t id) const { return faces_[slots_[id]]; }

 private:
  // Corners of a part that are lit.
  struct LitPart {
    std::vector<std::uint32_t> corner;
    std::vector<float>
        arrays;  // x, y, z, of the normal x, y, z, red, green, blue, one after another
  };
  // A triangle that was asked for: its part and where its corners stand there.
  struct Asked {
    std::uint32_t part = 0, triangle = 0;
    std::array<std::uint32_t, 3> corner{}, lit{};
  };
  void light(const PlacedMeshes& meshes, std::uint32_t part);
  void face(const PlacedMeshes& meshes, const Asked& asked, SeenFace& face) const;

  std::vector<std::uint32_t> slots_;  // by number, into ids_ where that has the number
  std::vector<std::uint32_t> ids_;
  std::vector<Asked> asked_;
  std::vector<SeenFace> faces_;
  std::vector<std::uint32_t> corner_slots_;  // by corner, into its part's, alike
  std::vector<LitPart> lit_;                 // by part
  std::vector<std::uint32_t> lit_parts_;
};

}  // namespace probe::render
