#include "runtime/render/picture.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

#include "runtime/render/clones.h"
#include "runtime/render/encode.h"

namespace probe::render {
namespace {

// A colour's bytes, red lowest.
using PackedRgb = std::uint32_t;

// to_display_byte() of each, shifted and added. Two loops: compilers make neither an array loop if
// they are one.
PROBE_CLONES void encode_all(const float* __restrict linear, std::size_t count, std::uint32_t shift,
                             PackedRgb* __restrict packed) {
  alignas(64) std::array<float, kTileSamples> inside;
  for (std::size_t i = 0; i < count; ++i) {
    const float above = linear[i] > kDarkest ? linear[i] : kDarkest;
    inside[i] = above < 1 ? above : 1;
  }
  for (std::size_t i = 0; i < count; ++i) {
    const DisplayStep& step = step_of(inside[i]);
    packed[i] |= (step.byte + (inside[i] >= step.next ? 1u : 0u)) << shift;
  }
}

inline void write(PackedRgb color, std::uint8_t* rgb) {
  rgb[0] = static_cast<std::uint8_t>(color);
  rgb[1] = static_cast<std::uint8_t>(color >> 8);
  rgb[2] = static_cast<std::uint8_t>(color >> 16);
}

// Four pixels that follow each other. Little-endian: the fourth byte of a word is the next pixel's
// first, which is written after it.
inline void write4(PackedRgb a, PackedRgb b, PackedRgb c, PackedRgb d, std::uint8_t* rgb) {
  static_assert(std::endian::native == std::endian::little);
  const PackedRgb words[3] = {a | b << 24, b >> 8 | c << 16, c >> 16 | d << 8};
  std::memcpy(rgb, words, sizeof words);
}

}  // namespace

void Picture::clear(int new_width, int new_height) {
  width = new_width;
  height = new_height;
  const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  rgb.assign(3 * pixels, 0);
  depth.assign(pixels, 0);
  segmentation.assign(pixels, 0);
}

void Picture::resize(int new_width, int new_height) {
  width = new_width;
  height = new_height;
  const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  rgb.resize(3 * pixels);
  depth.resize(pixels);
  segmentation.resize(pixels);
}

void show_hits(const TileHits& hits, const TopScene& scene, const CameraRays& rays, int tile,
               const ShadeOutput* colors, Picture& picture) {
  const float* cosine = rays.cosine.data() + rays.base(tile);
  const int left = tile % rays.tiles_x * kTileSide, top = tile / rays.tiles_x * kTileSide;
  const auto count = static_cast<std::size_t>(hits.count);
  alignas(64) std::array<PackedRgb, kTileSamples> rgb;
  if (colors != nullptr) {
    std::fill_n(rgb.data(), count, 0u);
    encode_all(colors->r.data(), count, 0, rgb.data());
    encode_all(colors->g.data(), count, 8, rgb.data());
    encode_all(colors->b.data(), count, 16, rgb.data());
  }
  const bool is_inside = left + kTileSide <= rays.width && top + kTileSide <= rays.height;
  const std::size_t corner = is_inside ? picture.at(left, top) : 0;
  const auto width = static_cast<std::size_t>(picture.width);
  std::uint32_t last = ~0u;
  std::uint16_t id = 0;
  const auto look_at = [&](std::uint32_t instance) {
    if (instance == last) return;
    last = instance;
    id = scene.instances()[instance].id;
  };
  for (std::size_t i = 0; i < count;) {
    const std::size_t sample = hits.sample[i];
    const TileOffset at = kTileOffsets[sample];
    // Most hits come as whole packets, of 4 x 2 pixels.
    const bool is_packet =
        is_inside && sample % 8 == 0 && i + 8 <= count && hits.sample[i + 7] == sample + 7;
    if (is_packet) {
      for (std::size_t row = 0; row < 2; ++row) {
        const std::size_t pixel = corner + (at.y + row) * width + at.x;
        const std::size_t k[4] = {2 * row, 2 * row + 1, 2 * row + 4, 2 * row + 5};
        for (std::size_t x = 0; x < 4; ++x) {
          picture.depth[pixel + x] = hits.t[i + k[x]] * cosine[sample + k[x]];
          look_at(hits.instance[i + k[x]]);
          picture.segmentation[pixel + x] = id;
        }
        if (colors == nullptr) continue;
        write4(rgb[i + k[0]], rgb[i + k[1]], rgb[i + k[2]], rgb[i + k[3]],
               picture.rgb.data() + 3 * pixel);
      }
      i += 8;
      continue;
    }
    const std::size_t now = i++;
    if (left + at.x >= rays.width || top + at.y >= rays.height) continue;
    const std::size_t pixel = picture.at(left + at.x, top + at.y);
    picture.depth[pixel] = hits.t[now] * cosine[sample];
    look_at(hits.instance[now]);
    picture.segmentation[pixel] = id;
    if (colors != nullptr) write(rgb[now], picture.rgb.data() + 3 * pixel);
  }
}

void restore_block(const Picture& from, int block_x, int block_y, int samples, Picture& to) {
  const int side = kBlockSide / samples;
  const int left = block_x * side, top = block_y * side;
  const int columns = std::min(side, from.width - left);
  if (columns <= 0) return;
  const auto n = static_cast<std::size_t>(columns);
  for (int y = top; y < std::min(top + side, from.height); ++y) {
    const std::size_t at = from.at(left, y);
    std::memcpy(to.rgb.data() + 3 * at, from.rgb.data() + 3 * at, 3 * n);
    std::memcpy(to.depth.data() + at, from.depth.data() + at, sizeof(float) * n);
    std::memcpy(to.segmentation.data() + at, from.segmentation.data() + at,
                sizeof(std::uint16_t) * n);
  }
}

}  // namespace probe::render
