// The strips of a video frame.
#include "runtime/show/overlay.h"

#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

namespace probe::show {
namespace {

using Color = std::array<std::uint8_t, 3>;
constexpr Color kWhite = {255, 255, 255};
constexpr Color kGrey = {170, 170, 170};
constexpr Color kGreen = {110, 230, 120};

// A quarter of the light stays, so that words can be read on any picture.
void darken(Picture& picture, int y0, int height) {
  for (int y = std::max(0, y0); y < std::min(picture.height, y0 + height); ++y) {
    const std::size_t row =
        3 * static_cast<std::size_t>(y) * static_cast<std::size_t>(picture.width);
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

void draw_overlay(Picture& picture, const OverlayText& text, Lettering& lettering) {
  const int scale = picture.width >= 480 ? 2 : 1;
  const int size = kSmallText * scale, line = line_height(size), pad = 3 * scale;
  const int room = picture.width - 2 * pad;
  darken(picture, 0, line + line_height(kSmallText) + 2 * pad);
  lettering.draw(picture, pad, pad, lettering.fit(text.instruction, room, size), kWhite, size);
  lettering.draw(picture, pad, pad + line, lettering.fit(text.caption, room, kSmallText), kGrey,
                 kSmallText);

  // Metrics flow into as many lines as they need, upwards from the bottom edge.
  struct Word {
    std::string text;
    bool on = false;
    int x = 0;
  };
  const int box = 6 * scale, space = size;
  const std::string steps =
      "step " + std::to_string(text.step) + "/" + std::to_string(text.horizon);
  std::vector<std::vector<Word>> lines(1);
  int x = pad + lettering.width(steps, size) + space;
  for (const store::MetricValue& metric : text.metrics) {
    Word word{metric_text(metric), !metric.is_bool || metric.value != 0, 0};
    const int width = box + scale + lettering.width(word.text, size);
    if (x + width > picture.width && !lines.back().empty()) {
      lines.emplace_back();
      x = pad;
    }
    word.x = x;
    lines.back().push_back(std::move(word));
    x += width + space;
  }
  const int height = static_cast<int>(lines.size()) * line + pad;
  darken(picture, picture.height - height, height);
  int y = picture.height - height + pad / 2;
  lettering.draw(picture, pad, y, steps, kWhite, size);
  for (const std::vector<Word>& words : lines) {
    for (const Word& word : words) {
      const Color color = word.on ? kGreen : kGrey;
      const int top = y + size - box;  // on the letters' base line
      fill(picture, word.x, top, box, box, color);
      if (!word.on) {
        fill(picture, word.x + scale, top + scale, box - 2 * scale, box - 2 * scale, {0, 0, 0});
      }
      lettering.draw(picture, word.x + box + scale, y, word.text, color, size);
    }
    y += line;
  }
}

}  // namespace probe::show
