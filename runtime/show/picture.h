// A picture for people, and what can be done with one without a word.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace probe::show {

// RGB, row 0 on top.
struct Picture {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;
};

Picture make_picture(int width, int height, std::array<std::uint8_t, 3> color);
Picture copy_picture(int width, int height, std::span<const std::uint8_t> rgb);
// Averages the pixels under each new one.
Picture shrink(const Picture& picture, int width, int height);
// Copies what fits.
void paste(Picture& onto, const Picture& what, int x, int y);
void fill(Picture& picture, int x, int y, int width, int height, std::array<std::uint8_t, 3> color);

}  // namespace probe::show
