// From sRGB bytes to linear light and textures read at a point. The tables are constants made by
// the compiler, so no C library's pow can change a picture. Knows nothing of rays or lights.
#pragma once

#include <array>
#include <cmath>

#include "runtime/scene/mesh.h"

namespace probe::scene {

// The fifth root of a in [0, 1] by Newton's method from above: it stops when it no longer falls.
constexpr double fifth_root(double a) {
  if (a <= 0) return 0;
  double x = 1;
  for (;;) {
    const double x4 = x * x * x * x;
    const double next = (4 * x + a / x4) / 5;
    if (!(next < x)) return x;
    x = next;
  }
}

constexpr std::array<float, 256> make_srgb_to_linear() {
  std::array<float, 256> table{};
  for (int i = 0; i < 256; ++i) {
    const double s = i / 255.0;
    const double b = (s + 0.055) / 1.055;
    const double b3 = b * b * b;
    const double b12 = (b3 * b3) * (b3 * b3);  // b^2.4 is the fifth root of b^12
    table[static_cast<std::size_t>(i)] =
        static_cast<float>(s <= 0.04045 ? s / 12.92 : fifth_root(b12));
  }
  return table;
}

// Linear light of an sRGB byte.
inline constexpr std::array<float, 256> kSrgbToLinear = make_srgb_to_linear();

struct LinearRgb {
  float r, g, b;
};

// Four texels by column and row, and their weights: where a bilinear sample reads.
struct Texels {
  int x0, y0, x1, y1;
  float across, down;
};

// Wrapping on both axes; row 0 lies at v = 0. u and v must be finite. Without branches, so that
// loops over many samples become vector code.
inline Texels texels_at(int width, int height, float u, float v) {
  const float x = (u - std::floor(u)) * static_cast<float>(width) - 0.5f;
  const float y = (v - std::floor(v)) * static_cast<float>(height) - 0.5f;
  const float floor_x = std::floor(x), floor_y = std::floor(y);
  const int x0 = static_cast<int>(floor_x), y0 = static_cast<int>(floor_y);
  const int x1 = x0 + 1, y1 = y0 + 1;
  return {x0 < 0 ? x0 + width : x0,
          y0 < 0 ? y0 + height : y0,
          x1 >= width ? x1 - width : x1,
          y1 >= height ? y1 - height : y1,
          x - floor_x,
          y - floor_y};
}

// Four texels of RGBA bytes, decoded: three channels in one register.
using DecodedRgb = float __attribute__((vector_size(16)));
struct DecodedTexels {
  DecodedRgb upper_left, upper_right, lower_left, lower_right;
};
inline DecodedRgb decode(const std::uint8_t* rgba) {
  return DecodedRgb{kSrgbToLinear[rgba[0]], kSrgbToLinear[rgba[1]], kSrgbToLinear[rgba[2]], 0};
}

inline LinearRgb mix_texels(const DecodedTexels& at, float across, float down) {
  const DecodedRgb top = at.upper_left * (1 - across) + at.upper_right * across;
  const DecodedRgb bottom = at.lower_left * (1 - across) + at.lower_right * across;
  const DecodedRgb mixed = top * (1 - down) + bottom * down;
  return {mixed[0], mixed[1], mixed[2]};
}

inline LinearRgb sample_texture(const Texture& texture, float u, float v) {
  const Texels at = texels_at(texture.width, texture.height, u, v);
  const auto texel = [&](int x, int y) {
    const std::size_t row = static_cast<std::size_t>(y) * static_cast<std::size_t>(texture.width);
    return decode(texture.rgba.data() + 4 * (row + static_cast<std::size_t>(x)));
  };
  return mix_texels(
      {texel(at.x0, at.y0), texel(at.x1, at.y0), texel(at.x0, at.y1), texel(at.x1, at.y1)},
      at.across, at.down);
}

}  // namespace probe::scene
