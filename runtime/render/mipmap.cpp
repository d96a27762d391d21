#include "runtime/render/mipmap.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "runtime/render/clones.h"

namespace probe::render {
namespace {

using Word = std::uint32_t __attribute__((may_alias));  // four bytes of a texel: red lowest

// A texture's sizes: the first, and all others one after another.
struct Sizes {
  const Word *first, *others;
  const std::int32_t* offset;  // among the others, by size
  int width, height;           // of the first, each other size being half of the one before
};

// Between the four texels about places, each in a size of its own; texel centres lie at + 0.5.
// `kIn`: places are in the first size, in others, or in any. Inlined, so that clones have loops of
// their own.
enum class In : std::uint8_t { kFirst, kOthers, kAny };
template <In kIn>
[[gnu::always_inline]] inline void bilinear(const Sizes& of, const std::int32_t* __restrict size,
                                            const float* __restrict u, const float* __restrict v,
                                            std::size_t count, float* __restrict red,
                                            float* __restrict green, float* __restrict blue) {
  const Word* const first = of.first;
  const Word* const others = of.others;
  const std::int32_t* const offsets = of.offset;
  const int all_width = of.width, all_height = of.height;
  PROBE_INDEPENDENT
  for (std::size_t i = 0; i < count; ++i) {
    const std::int32_t at = kIn == In::kFirst ? 0 : size[i];
    const int halved_width = all_width >> at, halved_height = all_height >> at;
    const int width = halved_width < 1 ? 1 : halved_width;
    const int height = halved_height < 1 ? 1 : halved_height;
    const int offset = kIn == In::kFirst ? 0 : offsets[at];
    const float x = (u[i] - std::floor(u[i])) * static_cast<float>(width) - 0.5f;
    const float y = (v[i] - std::floor(v[i])) * static_cast<float>(height) - 0.5f;
    const float floor_x = std::floor(x), floor_y = std::floor(y);
    const float across = x - floor_x, down = y - floor_y;
    const int left = static_cast<int>(floor_x), top = static_cast<int>(floor_y);
    const int x0 = left < 0 ? left + width : left, y0 = top < 0 ? top + height : top;
    const int x1 = left + 1 >= width ? left + 1 - width : left + 1;
    const int y1 = top + 1 >= height ? top + 1 - height : top + 1;
    const auto texel = [&](int index) -> std::uint32_t {
      if constexpr (kIn == In::kFirst) return first[index];
      if constexpr (kIn == In::kOthers) return others[index];
      const std::uint32_t in_first = first[at == 0 ? index : 0];
      const std::uint32_t in_others = others[at == 0 ? 0 : index];
      return at == 0 ? in_first : in_others;
    };
    const int upper = offset + y0 * width, lower = offset + y1 * width;
    const std::uint32_t upper_left = texel(upper + x0), lower_left = texel(lower + x0);
    const std::uint32_t upper_right = texel(upper + x1), lower_right = texel(lower + x1);
    const auto between = [&](int shift) {
      const auto byte = [&](std::uint32_t four) {
        return static_cast<float>(static_cast<std::int32_t>(four >> shift & 255u));
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

PROBE_CLONES void read_first(const Sizes& of, const std::int32_t* size, const float* u,
                             const float* v, std::size_t count, float* red, float* green,
                             float* blue) {
  bilinear<In::kFirst>(of, size, u, v, count, red, green, blue);
}
PROBE_CLONES void read_others(const Sizes& of, const std::int32_t* size, const float* u,
                              const float* v, std::size_t count, float* red, float* green,
                              float* blue) {
  bilinear<In::kOthers>(of, size, u, v, count, red, green, blue);
}
PROBE_CLONES void read_any(const Sizes& of, const std::int32_t* size, const float* u,
                           const float* v, std::size_t count, float* red, float* green,
                           float* blue) {
  bilinear<In::kAny>(of, size, u, v, count, red, green, blue);
}

// In a texture of one size.
inline Rgb bilinear(const std::uint8_t* rgba, int width, int height, float u, float v) {
  float red, green, blue;
  const Sizes only{reinterpret_cast<const Word*>(rgba), nullptr, nullptr, width, height};
  read_first(only, nullptr, &u, &v, 1, &red, &green, &blue);
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
  levels_.push_back({texture.width, texture.height, texture.rgba.data()});
  offsets_.push_back(0);
  std::size_t texels = 0;
  while (levels_.back().width > 1 || levels_.back().height > 1) {
    const Level& from = levels_.back();
    const Level to{std::max(1, from.width / 2), std::max(1, from.height / 2), nullptr};
    offsets_.push_back(static_cast<std::int32_t>(texels));
    texels += static_cast<std::size_t>(to.width) * static_cast<std::size_t>(to.height);
    levels_.push_back(to);
  }
  own_.resize(4 * texels);
  for (std::size_t level = 1; level < levels_.size(); ++level) {
    const Level& from = levels_[level - 1];
    Level& to = levels_[level];
    std::uint8_t* texel = own_.data() + 4 * static_cast<std::size_t>(offsets_[level]);
    to.rgba = texel;
    for (int y = 0; y < to.height; ++y) {
      for (int x = 0; x < to.width; ++x, texel += 4) {
        const Rgb mean = bilinear(from.rgba, from.width, from.height,
                                  (static_cast<float>(x) + 0.5f) / static_cast<float>(to.width),
                                  (static_cast<float>(y) + 0.5f) / static_cast<float>(to.height));
        for (int k = 0; k < 3; ++k) texel[k] = static_cast<std::uint8_t>(mean[k] + 0.5f);
        texel[3] = 255;
      }
    }
  }
}

Rgb MipChain::at(float u, float v, float texels) const {
  float red = 0, green = 0, blue = 0;
  read_block(&u, &v, &texels, 1, {&red, &green, &blue});
  return Rgb{red, green, blue, 0};
}

namespace {

constexpr std::size_t kBlockPlaces = 256;

struct Found {
  std::int32_t least, greatest;  // size
  bool is_between;               // some place lies between two
};

// Places kept near enough, and the level each is read at: whole levels, and what is beyond.
PROBE_CLONES Found find_levels(const float* __restrict u, const float* __restrict v,
                               const float* __restrict texels, std::size_t count,
                               std::int32_t last_level, float* __restrict near_u,
                               float* __restrict near_v, std::int32_t* __restrict fine,
                               float* __restrict toward) {
  constexpr float kFar = 1e6f;  // beyond it a float has no fraction
  const auto last = static_cast<float>(last_level);
  std::int32_t lowest = last_level, highest = 0, between = 0;
  for (std::size_t i = 0; i < count; ++i) {
    near_u[i] = u[i] < -kFar ? -kFar : (kFar < u[i] ? kFar : u[i]);
    near_v[i] = v[i] < -kFar ? -kFar : (kFar < v[i] ? kFar : v[i]);
    const float by_size = log2_of(texels[i]);
    const float level = texels[i] > 1 ? (last < by_size ? last : by_size) : 0;
    fine[i] = static_cast<std::int32_t>(level);
    toward[i] = level - static_cast<float>(fine[i]);
    lowest = fine[i] < lowest ? fine[i] : lowest;
    highest = fine[i] > highest ? fine[i] : highest;
    between |= toward[i] > 0 ? 1 : 0;
  }
  return {lowest, highest, between != 0};
}

PROBE_CLONES void mix(const float* __restrict there, const float* __restrict toward,
                      std::size_t count, float* __restrict color) {
  for (std::size_t i = 0; i < count; ++i) {
    const float here = color[i];
    color[i] = toward[i] > 0 ? here * (1 - toward[i]) + there[i] * toward[i] : here;
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
  const Found found =
      find_levels(u, v, texels, count, static_cast<std::int32_t>(levels_.size() - 1), near_u.data(),
                  near_v.data(), fine.data(), toward.data());
  const Sizes sizes{reinterpret_cast<const Word*>(levels_[0].rgba),
                    reinterpret_cast<const Word*>(own_.data()), offsets_.data(), levels_[0].width,
                    levels_[0].height};
  const auto read = found.greatest == 0 ? read_first : found.least > 0 ? read_others : read_any;
  read(sizes, fine.data(), near_u.data(), near_v.data(), count, color[0], color[1], color[2]);
  if (!found.is_between) return;
  // The next size, and the last again where there is none.
  std::array<std::int32_t, kBlockPlaces> coarse;
  const auto last = static_cast<std::int32_t>(levels_.size() - 1);
  for (std::size_t i = 0; i < count; ++i) coarse[i] = std::min(fine[i] + 1, last);
  std::array<Block, 3> there;
  read_others(sizes, coarse.data(), near_u.data(), near_v.data(), count, there[0].data(),
              there[1].data(), there[2].data());
  for (std::size_t k = 0; k < 3; ++k) mix(there[k].data(), toward.data(), count, color[k]);
}

}  // namespace probe::render
