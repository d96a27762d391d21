// Linear light to display bytes: floor(255 c^(1/2.2)), truncated as the reference does, by
// comparison with 256 stored thresholds. Not the sRGB curve.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

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

inline constexpr int kGuesses = 4096;

constexpr std::array<std::uint8_t, kGuesses> make_display_guesses() {
  std::array<std::uint8_t, kGuesses> table{};
  std::size_t k = 0;
  for (std::size_t i = 0; i < kGuesses; ++i) {
    const float least = static_cast<float>(i) / kGuesses;
    while (k < 255 && kDisplayThresholds[k + 1] <= least) ++k;
    table[i] = static_cast<std::uint8_t>(k);
  }
  return table;
}

// The byte of the least value in each 4096th of [0, 1): a lower bound, from which a few comparisons
// lead to the byte.
inline constexpr std::array<std::uint8_t, kGuesses> kDisplayGuesses = make_display_guesses();

// NaN and negative values give 0, values above 1 give 255.
inline std::uint8_t to_display_byte(float linear) {
  if (!(linear > 0)) return 0;
  if (linear >= 1) return 255;
  std::size_t k = kDisplayGuesses[static_cast<std::size_t>(linear * static_cast<float>(kGuesses))];
  while (linear >= kDisplayThresholds[k + 1]) ++k;  // ends: threshold 255 is 1
  return static_cast<std::uint8_t>(k);
}

// What a sample counts in the mean of a pixel: light above 1 shows as 1, NaN as 0.
inline float capped(float linear) {
  if (!(linear > 0)) return 0;
  return linear < 1 ? linear : 1;
}

}  // namespace probe::render
