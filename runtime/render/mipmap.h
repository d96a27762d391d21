// A texture at falling sizes, read between texels and between sizes as OpenGL's trilinear filter
// reads them. Bytes stay as the file has them: the vertex law knows no linear light.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "runtime/scene/mesh.h"

namespace probe::render {

using Rgb = float __attribute__((vector_size(16)));  // red, green, blue, nothing; 0 .. 255

class MipChain {
 public:
  // `texture` must outlive the chain.
  explicit MipChain(const scene::Texture& texture);
  int width() const { return levels_[0].width; }
  int height() const { return levels_[0].height; }
  // Repeats on both axes, row 0 at v = 0. `texels`: how many of level 0 a step of a pixel crosses.
  Rgb at(float u, float v, float texels) const;
  // The same of many places: red, green and blue.
  void read(std::span<const float> u, std::span<const float> v, std::span<const float> texels,
            const std::array<float*, 3>& color) const;

 private:
  struct Level {
    int width = 0, height = 0;
    const std::uint8_t* rgba = nullptr;
  };
  void read_block(const float* u, const float* v, const float* texels, std::size_t count,
                  const std::array<float*, 3>& color) const;
  std::vector<Level> levels_;
  std::vector<std::uint8_t> own_;      // all sizes but the first, which is the texture's
  std::vector<std::int32_t> offsets_;  // of sizes in own_, texels; 0 of the first
};

}  // namespace probe::render
