// Pixels that show several triangles, or whose neighbours show others: the mean of what their
// samples show, and whose depth and id they have.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "runtime/render/picture.h"
#include "runtime/render/sample_buffer.h"
#include "runtime/render/seen_faces.h"
#include "runtime/render/texture_reads.h"

namespace probe::render {

class MixedPixels {
 public:
  static constexpr std::size_t kMost = 512;  // pixels
  // What one triangle shows in a pixel, in `samples` of its four.
  struct Fragment {
    std::uint32_t face = 0;  // in SeenFaces
    std::int32_t samples = 0;
  };
  struct Pixel {
    float across = 0, down = 0;  // of its middle
    std::uint16_t x = 0, y = 0;
    std::uint32_t end = 0;  // of its fragments, which begin where those of the pixel before end
  };

  MixedPixels() : arrays_(std::make_unique<Arrays>()) {}

  void clear() { pixels_ = fragments_ = 0; }
  // `ids`: of the four samples.
  void add(std::uint16_t x, std::uint16_t y, float across, float down, const std::uint32_t* ids,
           SeenFaces& faces);
  void light(const SeenFaces& faces, const PixelStep& step);
  // More light on what `holds` says of the triangles' numbers, 0 .. 255.
  void add_light(const SeenFaces& faces, const auto& holds, const auto& rgb_at) {
    std::size_t first = 0;
    for (std::size_t i = 0; i < pixels_; ++i) {
      const Pixel& pixel = arrays_->pixel[i];
      for (std::size_t f = first; f < pixel.end; ++f) {
        if (!holds(faces[arrays_->fragment[f].face].id)) continue;
        const std::uint8_t* rgb = rgb_at(pixel.x, pixel.y);
        for (int k = 0; k < 3; ++k) arrays_->color[f][k] += static_cast<float>(rgb[k]);
      }
      first = pixel.end;
    }
  }
  void write(const SeenFaces& faces, const SampleBuffer& samples, Picture& picture) const;

 private:
  std::size_t middle_of(const SeenFaces& faces, const Pixel& pixel, std::size_t first) const;

  struct Arrays {
    std::array<Pixel, kMost> pixel;
    std::array<Fragment, 4 * kMost> fragment;
    std::array<Rgb, 4 * kMost> color;  // 0 .. 255
    std::array<float, 4 * kMost> denominator;
  };
  std::unique_ptr<Arrays> arrays_;
  std::size_t pixels_ = 0, fragments_ = 0;
  TextureReads reads_;
};

}  // namespace probe::render
