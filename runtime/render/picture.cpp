#include "runtime/render/picture.h"

#include <algorithm>
#include <array>
#include <cstring>

#include "runtime/render/clones.h"
#include "runtime/render/encode.h"

namespace probe::render {
namespace {

// to_display_byte() of each. Two loops: compilers make neither an array loop if they are one.
PROBE_CLONES void encode_all(const float* __restrict linear, std::size_t count,
                             std::uint8_t* __restrict bytes) {
  alignas(64) std::array<float, kTileSamples> inside;
  for (std::size_t i = 0; i < count; ++i) {
    const float above = linear[i] > kDarkest ? linear[i] : kDarkest;
    inside[i] = above < 1 ? above : 1;
  }
  for (std::size_t i = 0; i < count; ++i) {
    const DisplayStep& step = step_of(inside[i]);
    bytes[i] = static_cast<std::uint8_t>(step.byte + (inside[i] >= step.next ? 1 : 0));
  }
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

void show_hits(const TileHits& hits, const TopScene& scene, const CameraRays& rays, int tile,
               const ShadeOutput* colors, Picture& picture) {
  const float* cosine = rays.cosine.data() + static_cast<std::size_t>(tile) * kTileSamples;
  const int left = tile % rays.tiles_x * kTileSide, top = tile / rays.tiles_x * kTileSide;
  const auto count = static_cast<std::size_t>(hits.count);
  std::array<std::uint8_t, kTileSamples> red, green, blue;
  if (colors != nullptr) {
    encode_all(colors->r.data(), count, red.data());
    encode_all(colors->g.data(), count, green.data());
    encode_all(colors->b.data(), count, blue.data());
  }
  std::uint32_t last = ~0u;
  std::uint16_t id = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t sample = hits.sample[i];
    const int x = left + kTileOffsets[sample].x, y = top + kTileOffsets[sample].y;
    if (x >= rays.width || y >= rays.height) continue;
    const std::size_t pixel = picture.at(x, y);
    picture.depth[pixel] = hits.t[i] * cosine[sample];
    if (hits.instance[i] != last) {
      last = hits.instance[i];
      id = scene.instances()[last].id;
    }
    picture.segmentation[pixel] = id;
    if (colors == nullptr) continue;
    std::uint8_t* rgb = picture.rgb.data() + 3 * pixel;
    rgb[0] = red[i];
    rgb[1] = green[i];
    rgb[2] = blue[i];
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
