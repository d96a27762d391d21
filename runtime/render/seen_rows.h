// Pixels that follow each other in a row and show one triangle alone: their colours and depths, as
// arrays.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "runtime/render/picture.h"
#include "runtime/render/sample_buffer.h"
#include "runtime/render/seen_faces.h"
#include "runtime/render/texture_reads.h"

namespace probe::render {

class SeenRows {
 public:
  static constexpr std::size_t kMost = 512;  // pixels
  struct Row {
    std::uint32_t face = 0;  // in SeenFaces
    std::uint32_t first = 0, count = 0;
    std::uint16_t x = 0, y = 0;  // of the first
  };

  SeenRows() : arrays_(std::make_unique<Arrays>()) {}

  void clear() {
    rows_.clear();
    count_ = 0;
  }
  // `across`, `down`: of pixels' middles.
  void add(std::uint32_t face, std::uint16_t x, std::uint16_t y, std::size_t count,
           const float* across, float down);
  void light(const SeenFaces& faces, const PixelStep& step);
  // More light on one pixel of a row, 0 .. 255.
  void add_light(const Row& row, std::size_t pixel, const std::uint8_t* rgb);
  void write(const SeenFaces& faces, const SampleBuffer& samples, Picture& picture);
  const std::vector<Row>& rows() const { return rows_; }

  struct Arrays {
    std::array<float, kMost> across, down, denominator, depth;
    std::array<std::array<float, kMost>, 3> color;    // 0 .. 1, then 0 .. 255
    std::array<std::array<float, kMost>, 3> texture;  // 0 .. 255
    std::array<std::array<std::uint8_t, kMost>, 3> byte;
  };

 private:
  void light_run(const SeenFace& face, std::size_t first, std::size_t count, const PixelStep& step);

  std::unique_ptr<Arrays> arrays_;
  std::vector<Row> rows_;
  std::size_t count_ = 0;
  TextureReads reads_;
};

}  // namespace probe::render
