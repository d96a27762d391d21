// Places of textures that are to be read, together by texture: what is read for many at once costs
// a fraction.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "runtime/render/mipmap.h"

namespace probe::render {

class TextureReads {
 public:
  // Of each place: where it is in the texture and how many texels a step of a pixel crosses there,
  // as MipChain::read takes them.
  struct Places {
    float *u, *v, *texels;
  };
  // Room for `count` places, which are numbered from `first` on. It lasts until
  // the next call.
  Places add(const MipChain* texture, std::size_t first, std::size_t count);
  // `put(first, count, red, green, blue)` for what was added, 0 .. 255; nothing is to be read then.
  void read(const auto& put) {
    for (OfTexture& of : textures_) {
      if (of.count == 0) continue;
      colors_.resize(std::max(colors_.size(), 3 * of.count));
      const float *red = colors_.data(), *green = red + of.count, *blue = green + of.count;
      read_texture(of);
      for (const Run& run : of.runs) {
        put(std::size_t{run.first}, std::size_t{run.count}, red, green, blue);
        red += run.count;
        green += run.count;
        blue += run.count;
      }
      of.runs.clear();
      of.count = 0;
    }
  }

 private:
  struct Run {
    std::uint32_t first = 0, count = 0;
  };
  struct OfTexture {
    const MipChain* texture = nullptr;
    std::vector<Run> runs;
    std::vector<float> u, v, texels;
    std::size_t count = 0;
  };
  OfTexture& of(const MipChain* texture);
  void read_texture(const OfTexture& of);

  std::vector<OfTexture> textures_;
  std::size_t last_ = 0;  // neighbours are mostly of one texture
  std::vector<float> colors_;
};

}  // namespace probe::render
