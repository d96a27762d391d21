// Bitmap text, box-filter shrinking and the strips of a video frame.
#include "runtime/show/overlay.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "runtime/base/check.h"
#include "runtime/show/font.h"

namespace probe::show {
namespace {

using Color = std::array<std::uint8_t, 3>;
constexpr Color kWhite = {255, 255, 255};
constexpr Color kGrey = {170, 170, 170};
constexpr Color kGreen = {110, 230, 120};

std::size_t offset(const Picture& picture, int x, int y) {
  return 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(picture.width) +
              static_cast<std::size_t>(x));
}

void fill(Picture& picture, int x0, int y0, int width, int height, Color color) {
  for (int y = std::max(0, y0); y < std::min(picture.height, y0 + height); ++y) {
    for (int x = std::max(0, x0); x < std::min(picture.width, x0 + width); ++x) {
      std::copy(color.begin(), color.end(),
                picture.rgb.begin() + static_cast<std::ptrdiff_t>(offset(picture, x, y)));
    }
  }
}

// A quarter of the light stays, so that words can be read on any picture.
void darken(Picture& picture, int y0, int height) {
  for (int y = std::max(0, y0); y < std::min(picture.height, y0 + height); ++y) {
    const std::size_t row = offset(picture, 0, y);
    for (std::size_t i = 0; i < 3 * static_cast<std::size_t>(picture.width); ++i) {
      picture.rgb[row + i] = static_cast<std::uint8_t>(picture.rgb[row + i] / 4);
    }
  }
}

std::string metric_text(const store::MetricValue& metric) {
  if (metric.is_bool) return metric.name;
  char number[32];
  std::snprintf(number, sizeof number, "=%.3g", metric.value);
  return metric.name + number;
}

}  // namespace

Picture make_picture(int width, int height, Color color) {
  PROBE_CHECK(width > 0 && height > 0, "a picture has at least one pixel");
  Picture picture{width, height, {}};
  picture.rgb.resize(3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  fill(picture, 0, 0, width, height, color);
  return picture;
}

Picture copy_picture(int width, int height, std::span<const std::uint8_t> rgb) {
  PROBE_CHECK(rgb.size() == 3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height),
              "three bytes a pixel");
  return {width, height, {rgb.begin(), rgb.end()}};
}

Picture shrink(const Picture& picture, int width, int height) {
  Picture small = make_picture(width, height, {0, 0, 0});
  for (int y = 0; y < height; ++y) {
    const int top = y * picture.height / height;
    const int bottom = std::max(top + 1, (y + 1) * picture.height / height);
    for (int x = 0; x < width; ++x) {
      const int left = x * picture.width / width;
      const int right = std::max(left + 1, (x + 1) * picture.width / width);
      std::array<unsigned, 3> sum{};
      for (int v = top; v < bottom; ++v) {
        for (int u = left; u < right; ++u) {
          for (std::size_t c = 0; c < 3; ++c) sum[c] += picture.rgb[offset(picture, u, v) + c];
        }
      }
      const auto count = static_cast<unsigned>((bottom - top) * (right - left));
      for (std::size_t c = 0; c < 3; ++c) {
        small.rgb[offset(small, x, y) + c] =
            static_cast<std::uint8_t>((sum[c] + count / 2) / count);
      }
    }
  }
  return small;
}

void paste(Picture& onto, const Picture& what, int x, int y) {
  for (int v = std::max(0, -y); v < what.height && y + v < onto.height; ++v) {
    for (int u = std::max(0, -x); u < what.width && x + u < onto.width; ++u) {
      for (std::size_t c = 0; c < 3; ++c) {
        onto.rgb[offset(onto, x + u, y + v) + c] = what.rgb[offset(what, u, v) + c];
      }
    }
  }
}

void draw_text(Picture& picture, int x, int y, std::string_view text, Color color, int scale) {
  constexpr std::array<std::uint8_t, 8> kBox = {0x1f, 0x11, 0x11, 0x11, 0x11, 0x11, 0x1f, 0};
  for (const char raw : text) {
    const auto byte = static_cast<unsigned char>(raw);
    const auto& rows = byte >= 32 && byte < 127 ? kFont[byte - 32u] : kBox;
    for (int row = 0; row < kGlyphHeight; ++row) {
      for (int column = 0; column < kGlyphWidth - 1; ++column) {
        if ((rows[static_cast<std::size_t>(row)] >> (4 - column) & 1) == 0) continue;
        fill(picture, x + column * scale, y + row * scale, scale, scale, color);
      }
    }
    x += kGlyphWidth * scale;
  }
}

std::string fit_text(std::string_view text, int width, int scale) {
  const auto room = static_cast<std::size_t>(std::max(0, width / (kGlyphWidth * scale)));
  if (text.size() <= room) return std::string(text);
  if (room < 2) return {};
  return std::string(text.substr(0, room - 2)) + "..";
}

void draw_overlay(Picture& picture, const OverlayText& text) {
  const int scale = picture.width >= 480 ? 2 : 1;
  const int line = (kGlyphHeight + 2) * scale;
  const int pad = 3 * scale;
  darken(picture, 0, line + kGlyphHeight + 2 * pad);
  draw_text(picture, pad, pad, fit_text(text.instruction, picture.width - 2 * pad, scale), kWhite,
            scale);
  draw_text(picture, pad, pad + line, fit_text(text.caption, picture.width - 2 * pad, 1), kGrey, 1);

  // Metrics flow into as many lines as they need, upwards from the bottom edge.
  std::vector<std::vector<const store::MetricValue*>> lines(1);
  const std::string steps =
      "step " + std::to_string(text.step) + "/" + std::to_string(text.horizon);
  const int glyph = kGlyphWidth * scale;
  int x = pad + static_cast<int>(steps.size() + 2) * glyph;
  for (const store::MetricValue& metric : text.metrics) {
    const int width = static_cast<int>(metric_text(metric).size() + 3) * glyph;
    if (x + width > picture.width && !lines.back().empty()) {
      lines.emplace_back();
      x = pad;
    }
    lines.back().push_back(&metric);
    x += width;
  }
  const int height = static_cast<int>(lines.size()) * line + pad;
  darken(picture, picture.height - height, height);
  int y = picture.height - height + pad;
  draw_text(picture, pad, y, steps, kWhite, scale);
  x = pad + static_cast<int>(steps.size() + 2) * glyph;
  for (const auto& metrics : lines) {
    for (const store::MetricValue* metric : metrics) {
      const bool on = !metric->is_bool || metric->value != 0;
      const Color color = on ? kGreen : kGrey;
      const int box = 6 * scale;
      fill(picture, x, y, box, box, color);
      if (!on) fill(picture, x + scale, y + scale, box - 2 * scale, box - 2 * scale, {0, 0, 0});
      const std::string word = metric_text(*metric);
      draw_text(picture, x + box + scale, y, word, color, scale);
      x += static_cast<int>(word.size() + 3) * glyph;
    }
    x = pad;
    y += line;
  }
}

}  // namespace probe::show
