#include "runtime/scene/vertex_colors.h"

#include <algorithm>
#include <cmath>

namespace probe::scene {
namespace {

constexpr int kSide = 4;  // texels of a triangle's square

bool all_equal(std::span<const LinearRgb> colors) {
  return std::all_of(colors.begin(), colors.end(), [&](const LinearRgb& c) {
    return c.r == colors[0].r && c.g == colors[0].g && c.b == colors[0].b;
  });
}

void put(Texture& texture, int x, int y, const LinearRgb& color) {
  const std::size_t at =
      4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(texture.width) +
           static_cast<std::size_t>(x));
  texture.rgba[at] = to_srgb_byte(color.r);
  texture.rgba[at + 1] = to_srgb_byte(color.g);
  texture.rgba[at + 2] = to_srgb_byte(color.b);
  texture.rgba[at + 3] = 255;
}

}  // namespace

std::uint8_t to_srgb_byte(float linear) {
  const auto above = std::lower_bound(kSrgbToLinear.begin(), kSrgbToLinear.end(), linear);
  if (above == kSrgbToLinear.begin()) return 0;
  if (above == kSrgbToLinear.end()) return 255;
  const auto below = above - 1;
  const auto nearest = linear - *below < *above - linear ? below : above;
  return static_cast<std::uint8_t>(nearest - kSrgbToLinear.begin());
}

void bake_vertex_colors(std::span<const LinearRgb> colors, MeshPart& part, Material& material,
                        std::vector<Texture>& textures) {
  if (colors.empty()) return;
  if (all_equal(colors)) {
    material.base_color = {colors[0].r, colors[0].g, colors[0].b};
    return;
  }
  const std::size_t triangles = part.indices.size() / 3;
  const int across = static_cast<int>(std::ceil(std::sqrt(static_cast<double>(triangles))));
  Texture texture{kSide * across, kSide * across, {}};
  texture.rgba.resize(4 * static_cast<std::size_t>(texture.width) *
                      static_cast<std::size_t>(texture.height));
  MeshPart split;
  split.material = part.material;
  for (std::size_t t = 0; t < triangles; ++t) {
    const int x = kSide * static_cast<int>(t % static_cast<std::size_t>(across));
    const int y = kSide * static_cast<int>(t / static_cast<std::size_t>(across));
    const std::uint32_t* corner = part.indices.data() + 3 * t;
    const LinearRgb a = colors[corner[0]], b = colors[corner[1]], c = colors[corner[2]];
    for (int j = 0; j < kSide; ++j) {
      for (int i = 0; i < kSide; ++i) {
        const float u = static_cast<float>(i) / (kSide - 1),
                    v = static_cast<float>(j) / (kSide - 1);
        const float w = 1 - u - v;
        put(texture, x + i, y + j,
            {w * a.r + u * b.r + v * c.r, w * a.g + u * b.g + v * c.g,
             w * a.b + u * b.b + v * c.b});
      }
    }
    for (int k = 0; k < 3; ++k) {
      const std::size_t from = 3 * std::size_t{corner[k]};
      for (std::size_t j = 0; j < 3; ++j) {
        split.positions.push_back(part.positions[from + j]);
        split.normals.push_back(part.normals[from + j]);
      }
      const float side = static_cast<float>(texture.width);
      split.uv.push_back((static_cast<float>(x + (k == 1 ? kSide - 1 : 0)) + 0.5f) / side);
      split.uv.push_back((static_cast<float>(y + (k == 2 ? kSide - 1 : 0)) + 0.5f) / side);
      split.indices.push_back(static_cast<std::uint32_t>(3 * t) + static_cast<std::uint32_t>(k));
    }
  }
  part = std::move(split);
  material.base_color_texture = static_cast<int>(textures.size());
  textures.push_back(std::move(texture));
}

}  // namespace probe::scene
