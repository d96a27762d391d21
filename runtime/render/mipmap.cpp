#include "runtime/render/mipmap.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace probe::render {
namespace {

inline Rgb read(const std::uint8_t* texel) {
  return Rgb{static_cast<float>(texel[0]), static_cast<float>(texel[1]),
             static_cast<float>(texel[2]), 0};
}

// Between the four texels about a place of a level; texel centres lie at + 0.5.
inline Rgb bilinear(const std::uint8_t* rgba, int width, int height, float u, float v) {
  const float x = (u - std::floor(u)) * static_cast<float>(width) - 0.5f;
  const float y = (v - std::floor(v)) * static_cast<float>(height) - 0.5f;
  const float floor_x = std::floor(x), floor_y = std::floor(y);
  const float across = x - floor_x, down = y - floor_y;
  int x0 = static_cast<int>(floor_x), y0 = static_cast<int>(floor_y);
  int x1 = x0 + 1, y1 = y0 + 1;
  if (x0 < 0) x0 += width;
  if (y0 < 0) y0 += height;
  if (x1 >= width) x1 -= width;
  if (y1 >= height) y1 -= height;
  const std::uint8_t* upper = rgba + std::size_t{4} * static_cast<std::size_t>(y0 * width);
  const std::uint8_t* lower = rgba + std::size_t{4} * static_cast<std::size_t>(y1 * width);
  const Rgb left = read(upper + 4 * x0) * (1 - down) + read(lower + 4 * x0) * down;
  const Rgb right = read(upper + 4 * x1) * (1 - down) + read(lower + 4 * x1) * down;
  return left * (1 - across) + right * across;
}

// log2 of a positive float: its exponent, and a polynomial of its fraction that is right at both
// ends.
inline float log2_of(float x) {
  const auto bits = std::bit_cast<std::uint32_t>(x);
  const float exponent = static_cast<float>(static_cast<int>(bits >> 23) - 127);
  const float m = std::bit_cast<float>((bits & 0x007FFFFFu) | 0x3F800000u) - 1;
  return exponent + m * (1.4249f + m * (-0.5977f + m * 0.1728f));
}

}  // namespace

MipChain::MipChain(const scene::Texture& texture) {
  levels_.push_back({texture.width, texture.height, texture.rgba.data(), {}});
  while (levels_.back().width > 1 || levels_.back().height > 1) {
    const Level& from = levels_.back();
    Level to;
    to.width = std::max(1, from.width / 2);
    to.height = std::max(1, from.height / 2);
    to.own.resize(std::size_t{4} * static_cast<std::size_t>(to.width * to.height));
    for (int y = 0; y < to.height; ++y) {
      for (int x = 0; x < to.width; ++x) {
        const Rgb mean = bilinear(from.rgba, from.width, from.height,
                                  (static_cast<float>(x) + 0.5f) / static_cast<float>(to.width),
                                  (static_cast<float>(y) + 0.5f) / static_cast<float>(to.height));
        std::uint8_t* texel = to.own.data() + 4 * (y * to.width + x);
        for (int k = 0; k < 3; ++k) texel[k] = static_cast<std::uint8_t>(mean[k] + 0.5f);
        texel[3] = 255;
      }
    }
    to.rgba = to.own.data();  // a vector's bytes stay where they are when it is moved
    levels_.push_back(std::move(to));
  }
}

Rgb MipChain::at(float u, float v, float texels) const {
  constexpr float kFar = 1e6f;  // beyond it a float has no fraction
  u = std::clamp(u, -kFar, kFar);
  v = std::clamp(v, -kFar, kFar);
  const auto last = static_cast<float>(levels_.size() - 1);
  const float level = texels > 1 ? std::min(log2_of(texels), last) : 0;
  const auto fine = static_cast<std::size_t>(level);
  const float toward = level - static_cast<float>(fine);
  const Level& near = levels_[fine];
  const Rgb color = bilinear(near.rgba, near.width, near.height, u, v);
  if (toward <= 0) return color;
  const Level& far = levels_[fine + 1];
  return color * (1 - toward) + bilinear(far.rgba, far.width, far.height, u, v) * toward;
}

}  // namespace probe::render
