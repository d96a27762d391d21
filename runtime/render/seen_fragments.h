// What triangles show in the middles of pixels, as arrays: colour, texture and depth.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "runtime/render/mipmap.h"
#include "runtime/render/seen_faces.h"

namespace probe::render {

class SeenFragments {
 public:
  static constexpr std::size_t kMost = 2048;

  // What one triangle shows in one pixel, by number; neighbours of one triangle follow each other.
  struct Arrays {
    std::array<std::uint32_t, kMost> face;    // in SeenFaces
    std::array<std::int32_t, kMost> samples;  // of the pixel's four
    std::array<float, kMost> across, down;    // of the pixel's middle
    std::array<float, kMost> denominator, depth;
    std::array<std::array<float, kMost>, 3> color;    // 0 .. 1, then 0 .. 255
    std::array<std::array<float, kMost>, 3> texture;  // 0 .. 255
    std::array<std::array<std::uint8_t, kMost>, 3> byte;
  };

  SeenFragments() : arrays_(std::make_unique<Arrays>()) {}

  // How many of the arrays' first say a face, samples and a place.
  void resize(std::size_t count) { count_ = count; }
  // Colours times textures, 0 .. 255, and depths. A step of a pixel goes so far across and down.
  void light(const SeenFaces& faces, float step_across, float step_down);
  // Rounds colours to bytes.
  void round();

  Arrays& arrays() { return *arrays_; }
  const Arrays& arrays() const { return *arrays_; }

 private:
  // Where a texture is read, and for which fragments.
  struct Textured {
    const MipChain* texture = nullptr;
    struct Run {
      std::uint32_t first = 0, count = 0;
    };
    std::vector<Run> runs;
    std::vector<float> u, v, texels;
    std::size_t count = 0;
  };
  Textured& textured(const MipChain* texture);
  void light_run(const SeenFace& face, std::size_t first, std::size_t count, float step_across,
                 float step_down);
  void read_textures();

  std::unique_ptr<Arrays> arrays_;
  std::size_t count_ = 0;
  std::vector<Textured> textured_;
  std::size_t last_textured_ = 0;  // neighbours are mostly of one texture
  std::vector<float> texels_;
};

}  // namespace probe::render
