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

// Four texels and their weights: where a bilinear sample reads. Apart from the reading, so that a
// loop over many samples can wait for all texels at once.
struct Footprint {
  const std::uint8_t* upper = nullptr;  // rows of RGBA bytes
  const std::uint8_t* lower = nullptr;
  int left = 0, right = 0;  // bytes into a row
  float across = 0, down = 0;
};

// Wrapping on both axes; row 0 lies at v = 0. u and v must be finite.
inline Footprint footprint_at(const Texture& texture, float u, float v) {
  const int width = texture.width, height = texture.height;
  const float x = (u - std::floor(u)) * static_cast<float>(width) - 0.5f;
  const float y = (v - std::floor(v)) * static_cast<float>(height) - 0.5f;
  const float floor_x = std::floor(x), floor_y = std::floor(y);
  int x0 = static_cast<int>(floor_x), y0 = static_cast<int>(floor_y);
  int x1 = x0 + 1, y1 = y0 + 1;
  if (x0 < 0) x0 += width;
  if (y0 < 0) y0 += height;
  if (x1 >= width) x1 -= width;
  if (y1 >= height) y1 -= height;
  const std::size_t stride = 4 * static_cast<std::size_t>(width);
  const std::uint8_t* texels = texture.rgba.data();
  return {texels + stride * static_cast<std::size_t>(y0),
          texels + stride * static_cast<std::size_t>(y1),
          4 * x0,
          4 * x1,
          x - floor_x,
          y - floor_y};
}

// Between decoded texels.
inline LinearRgb sample_at(const Footprint& at) {
  using Rgbx = float __attribute__((vector_size(16)));  // three channels in one register
  const auto texel = [](const std::uint8_t* rgba) {
    return Rgbx{kSrgbToLinear[rgba[0]], kSrgbToLinear[rgba[1]], kSrgbToLinear[rgba[2]], 0};
  };
  const Rgbx top = texel(at.upper + at.left) * (1 - at.across) +
                   texel(at.upper + at.right) * at.across;
  const Rgbx bottom = texel(at.lower + at.left) * (1 - at.across) +
                      texel(at.lower + at.right) * at.across;
  const Rgbx mixed = top * (1 - at.down) + bottom * at.down;
  return {mixed[0], mixed[1], mixed[2]};
}

inline LinearRgb sample_texture(const Texture& texture, float u, float v) {
  return sample_at(footprint_at(texture, u, v));
}

}  // namespace probe::scene
