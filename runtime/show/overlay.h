// Words on pictures: a small bitmap font and the strip of instruction, step and metrics that videos
// carry. Never used on a picture that a policy sees.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/store/results.h"

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

// Characters are 6 x 8 pixels times `scale`; other bytes than printable ASCII show as a box.
inline constexpr int kGlyphWidth = 6, kGlyphHeight = 8;
void draw_text(Picture& picture, int x, int y, std::string_view text,
               std::array<std::uint8_t, 3> color, int scale = 1);
// Longest prefix that fits `width` pixels, with ".." when cut.
std::string fit_text(std::string_view text, int width, int scale);

struct OverlayText {
  std::string_view instruction;
  std::string_view caption;  // task, episode, seed, policy
  int step = 0, horizon = 0;
  std::span<const store::MetricValue> metrics;
};
// A dark strip on top (instruction) and below (step, metrics: filled marks are true).
void draw_overlay(Picture& picture, const OverlayText& text);

}  // namespace probe::show
