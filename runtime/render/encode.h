// Linear light to display bytes: floor(255 c^(1/2.2)), truncated as the reference does, by
// comparison with 256 stored thresholds. Not the sRGB curve.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "runtime/scene/color.h"

namespace probe::render {

constexpr std::array<float, 256> make_display_thresholds() {
  std::array<float, 256> table{};
  for (int k = 0; k < 256; ++k) {
    const double s = k / 255.0;
    const double s2 = s * s, s4 = s2 * s2;
    table[static_cast<std::size_t>(k)] =
        static_cast<float>(scene::fifth_root(s4 * s4 * s2 * s));  // s^2.2 = (s^11)^(1/5)
  }
  return table;
}

// The least linear value that shows as byte k: (k/255)^2.2.
inline constexpr std::array<float, 256> kDisplayThresholds = make_display_thresholds();

// One entry for each power of two and 128th within it, which are the top 16 bits of a float. Two
// thresholds lie at least a factor 1.0086 = (255/254)^2.2 apart and an entry spans at most 129/128
// = 1.0078, so that at most one lies within: the entry's least byte and one comparison give the
// byte.
inline constexpr float kDarkest = 0x1p-18f;  // below the threshold of byte 1, 5.1e-6
inline constexpr std::uint32_t kFirstStep = std::bit_cast<std::uint32_t>(kDarkest) >> 16;
inline constexpr std::uint32_t kSteps = (std::bit_cast<std::uint32_t>(1.0f) >> 16) - kFirstStep + 1;

struct DisplayStep {
  float next = 0;  // threshold of the byte after `byte`
  std::uint32_t byte = 0;
};

constexpr std::array<DisplayStep, kSteps> make_display_steps() {
  std::array<DisplayStep, kSteps> table{};
  std::uint32_t k = 0;
  for (std::uint32_t i = 0; i < kSteps; ++i) {
    const float least = std::bit_cast<float>((kFirstStep + i) << 16);
    while (k < 255 && kDisplayThresholds[k + 1] <= least) ++k;
    const float next = k < 255 ? kDisplayThresholds[k + 1] : std::numeric_limits<float>::infinity();
    table[i] = {next, k};
  }
  return table;
}
inline constexpr std::array<DisplayStep, kSteps> kDisplaySteps = make_display_steps();

// Of a value from kDarkest to 1.
inline const DisplayStep& step_of(float inside) {
  return kDisplaySteps[(std::bit_cast<std::uint32_t>(inside) >> 16) - kFirstStep];
}

// NaN and negative values give 0, values above 1 give 255.
inline std::uint8_t to_display_byte(float linear) {
  const float above = linear > kDarkest ? linear : kDarkest;
  const float inside = above < 1 ? above : 1;
  const DisplayStep& step = step_of(inside);
  return static_cast<std::uint8_t>(step.byte + (inside >= step.next ? 1 : 0));
}

// What a sample counts in the mean of a pixel: light above 1 shows as 1, NaN as 0.
inline float capped(float linear) {
  if (!(linear > 0)) return 0;
  return linear < 1 ? linear : 1;
}

}  // namespace probe::render
