#include "runtime/render/mipmap.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "runtime/render/clones.h"

namespace probe::render {
namespace {

using Word = std::uint32_t __attribute__((may_alias));  // four bytes of a texel: red lowest

// Between the four texels about places of a level; texel centres lie at + 0.5.
PROBE_CLONES void bilinear(const std::uint8_t* rgba, int width, int height,
                           const float* __restrict u, const float* __restrict v, std::size_t count,
                           float* __restrict red, float* __restrict green, float* __restrict blue) {
  const Word* const texels = reinterpret_cast<const Word*>(rgba);
  for (std::size_t i = 0; i < count; ++i) {
    const float x = (u[i] - std::floor(u[i])) * static_cast<float>(width) - 0.5f;
    const float y = (v[i] - std::floor(v[i])) * static_cast<float>(height) - 0.5f;
    const float floor_x = std::floor(x), floor_y = std::floor(y);
    const float across = x - floor_x, down = y - floor_y;
    const int left = static_cast<int>(floor_x), top = static_cast<int>(floor_y);
    const int x0 = left < 0 ? left + width : left, y0 = top < 0 ? top + height : top;
    const int x1 = left + 1 >= width ? left + 1 - width : left + 1;
    const int y1 = top + 1 >= height ? top + 1 - height : top + 1;
    const std::uint32_t upper_left = texels[y0 * width + x0], lower_left = texels[y1 * width + x0];
    const std::uint32_t upper_right = texels[y0 * width + x1],
                        lower_right = texels[y1 * width + x1];
    const auto between = [&](int shift) {
      const auto byte = [&](std::uint32_t texel) {
        return static_cast<float>(static_cast<std::int32_t>(texel >> shift & 255u));
      };
      const float on_left = byte(upper_left) * (1 - down) + byte(lower_left) * down;
      const float on_right = byte(upper_right) * (1 - down) + byte(lower_right) * down;
      return on_left * (1 - across) + on_right * across;
    };
    red[i] = between(0);
    green[i] = between(8);
    blue[i] = between(16);
  }
}

inline Rgb bilinear(const std::uint8_t* rgba, int width, int height, float u, float v) {
  float red, green, blue;
  bilinear(rgba, width, height, &u, &v, 1, &red, &green, &blue);
  return Rgb{red, green, blue, 0};
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
  float red = 0, green = 0, blue = 0;
  read_block(&u, &v, &texels, 1, {&red, &green, &blue});
  return Rgb{red, green, blue, 0};
}

namespace {

constexpr std::size_t kBlockPlaces = 256;

// Places kept near enough, and the level each is read at: whole levels, and what is beyond.
PROBE_CLONES void find_levels(const float* __restrict u, const float* __restrict v,
                              const float* __restrict texels, std::size_t count, float last,
                              float* __restrict near_u, float* __restrict near_v,
                              std::int32_t* __restrict fine, float* __restrict toward) {
  constexpr float kFar = 1e6f;  // beyond it a float has no fraction
  for (std::size_t i = 0; i < count; ++i) {
    near_u[i] = u[i] < -kFar ? -kFar : (kFar < u[i] ? kFar : u[i]);
    near_v[i] = v[i] < -kFar ? -kFar : (kFar < v[i] ? kFar : v[i]);
    const float by_size = log2_of(texels[i]);
    const float level = texels[i] > 1 ? (last < by_size ? last : by_size) : 0;
    fine[i] = static_cast<std::int32_t>(level);
    toward[i] = level - static_cast<float>(fine[i]);
  }
}

}  // namespace

void MipChain::read(std::span<const float> u, std::span<const float> v,
                    std::span<const float> texels, const std::array<float*, 3>& color) const {
  for (std::size_t first = 0; first < u.size(); first += kBlockPlaces)
    read_block(u.data() + first, v.data() + first, texels.data() + first,
               std::min(kBlockPlaces, u.size() - first),
               {color[0] + first, color[1] + first, color[2] + first});
}

void MipChain::read_block(const float* u, const float* v, const float* texels, std::size_t count,
                          const std::array<float*, 3>& color) const {
  using Block = std::array<float, kBlockPlaces>;
  Block near_u, near_v, toward;
  std::array<std::int32_t, kBlockPlaces> fine;
  find_levels(u, v, texels, count, static_cast<float>(levels_.size() - 1), near_u.data(),
              near_v.data(), fine.data(), toward.data());
  const auto [least_level, greatest_level] = std::minmax_element(fine.data(), fine.data() + count);
  for (std::int32_t level = *least_level, end = *greatest_level; level <= end; ++level) {
    std::array<std::uint16_t, kBlockPlaces> which;
    std::size_t of_level = 0;
    Block at_u, at_v;
    bool between = false;
    for (std::size_t i = 0; i < count; ++i) {
      if (fine[i] != level) continue;
      which[of_level] = static_cast<std::uint16_t>(i);
      at_u[of_level] = near_u[i];
      at_v[of_level++] = near_v[i];
      between = between || toward[i] > 0;
    }
    if (of_level == 0) continue;
    std::array<Block, 3> here, there;
    const auto look = [&](const Level& from, std::array<Block, 3>& to) {
      bilinear(from.rgba, from.width, from.height, at_u.data(), at_v.data(), of_level, to[0].data(),
               to[1].data(), to[2].data());
    };
    look(levels_[static_cast<std::size_t>(level)], here);
    if (between) look(levels_[static_cast<std::size_t>(level) + 1], there);
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t n = 0; n < of_level; ++n) {
        const std::size_t i = which[n];
        color[k][i] =
            toward[i] > 0 ? here[k][n] * (1 - toward[i]) + there[k][n] * toward[i] : here[k][n];
      }
    }
  }
}

}  // namespace probe::render
