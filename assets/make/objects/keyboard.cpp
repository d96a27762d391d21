// The keyboard: 15.2 x 6.4 x 1 cm, a dark body, five rows of tapered grey keys with light legends;
// read with +y up. Its frame lies 1 mm over its underside.
#include <array>
#include <string_view>

#include "assets/make/generators.h"
#include "assets/make/legend_font.h"
#include "assets/make/shapes.h"

namespace probe::make {
namespace {

// A row of keys: legends left to right; a digit after a key gives its width in quarters of a key.
struct Key {
  double left, width;  // key widths from the left
  int row;
  char legend;  // space: none
};

std::vector<Key> keys() {
  constexpr double kUnits = 15;
  struct Row {
    std::string_view legends;
    double first, last;  // widths of the first and last key
  };
  constexpr std::array<Row, 4> kRows{{{"`1234567890-=<", 1, 2},
                                      {">QWERTYUIOP[]\\", 1.5, 1.5},
                                      {"*ASDFGHJKL;'<", 1.75, 2.25},
                                      {"^ZXCVBNM,./^", 2.25, 2.75}}};
  std::vector<Key> all;
  for (std::size_t r = 0; r < kRows.size(); ++r) {
    double left = 0;
    for (std::size_t i = 0; i < kRows[r].legends.size(); ++i) {
      const bool is_last = i + 1 == kRows[r].legends.size();
      const double width = i == 0 ? kRows[r].first : is_last ? kUnits - left : 1;
      all.push_back({left, width, static_cast<int>(r), kRows[r].legends[i]});
      left += width;
    }
  }
  double left = 0;
  for (const double width : {1.25, 1.25, 1.25, 6.25, 1.25, 1.25, 1.25, 1.25}) {
    all.push_back({left, width, 4, ' '});
    left += width;
  }
  return all;
}

constexpr double kPitchX = 9.7, kPitchY = 11.3;  // mm
constexpr double kLeft = -7.5 * kPitchX, kUpper = 2.5 * kPitchY;

// A frustum without its bottom.
void add_key(Surface& surface, const Key& key, const Mapping& uv) {
  constexpr double kGap = 0.55, kTaper = 1.0, kFoot = 4.2, kTop = 9;
  const Vec2 centre(kLeft + (key.left + key.width / 2) * kPitchX,
                    kUpper - (key.row + 0.5) * kPitchY);
  const Vec2 half(key.width * kPitchX / 2 - kGap, kPitchY / 2 - kGap);
  const auto loop = [&](double inset, double z) {
    std::vector<Vec3> points;
    for (const auto& [x, y] :
         {std::pair{1, 1}, std::pair{-1, 1}, std::pair{-1, -1}, std::pair{1, -1}}) {
      points.emplace_back(centre.x() + x * (half.x() - inset), centre.y() + y * (half.y() - inset),
                          z);
    }
    return points;
  };
  const std::vector<Vec3> middle(4, Vec3(centre.x(), centre.y(), kTop));
  append(surface, skin({middle, loop(kTaper, kTop), loop(0, kFoot)}, true, uv));
}

Image top_texture() {
  constexpr int kWidth = 512, kHeight = 256;
  constexpr double kScaleX = kWidth / 154.0, kScaleY = kHeight / 66.0;
  const Colour body = texel_for({34, 35, 38}, kGainUp, 0.004);
  const Colour cap = texel_for({86, 88, 93}, kGainUp, 0.004);
  const Colour skirt = texel_for({64, 66, 70}, kGainUp, 0.004);
  const Colour legend = texel_for({226, 226, 222}, kGainUp, 0.004);
  Image image(kWidth, kHeight);
  for (int row = 0; row < kHeight; ++row) {
    for (int column = 0; column < kWidth; ++column) image.set(column, row, body);
  }
  for (const Key& key : keys()) {
    const double x0 = (77 + kLeft + key.left * kPitchX) * kScaleX,
                 w = key.width * kPitchX * kScaleX;
    const double y0 = (33 - kUpper + key.row * kPitchY) * kScaleY, h = kPitchY * kScaleY;
    for (int row = static_cast<int>(y0 + 1); row < y0 + h - 1; ++row) {
      for (int column = static_cast<int>(x0 + 1); column < x0 + w - 1; ++column) {
        const bool on_top =
            column > x0 + 5 && column < x0 + w - 5 && row > y0 + 6 && row < y0 + h - 6;
        image.set(column, row, on_top ? cap : skirt);
      }
    }
    if (key.legend == ' ') continue;
    const auto& glyph = kFont[static_cast<std::size_t>(key.legend - ' ')];
    const int left = static_cast<int>(x0 + w / 2) - 7, upper = static_cast<int>(y0 + h / 2) - 10;
    for (int y = 0; y < 21; ++y) {
      for (int x = 0; x < 15; ++x) {
        if (((glyph[static_cast<std::size_t>(y / 3)] >> (4 - x / 3)) & 1) == 0) continue;
        image.set(left + x, upper + y, legend);
      }
    }
  }
  return image;
}

}  // namespace

std::vector<OutputFile> make_keyboard() {
  const Mapping uv = seen_from_above({154, 66});
  Surface surface = cushion(
      {.half = {76, 32, 3.2}, .corner = 4, .rim = 1, .corner_steps = 3, .rim_steps = 2}, uv);
  move_points(surface, [](const Vec3& p) { return Vec3(p.x(), p.y(), p.z() + 2.2); });
  for (const Key& key : keys()) add_key(surface, key, uv);
  Surface* all[] = {&surface};
  fit_to_box(all, {{-0.076, -0.032, -0.001}, {0.076, 0.032, 0.009}});
  smooth_normals(surface, 35);
  std::vector<Vec3> body, block;
  for (const double z : {-1.0, 5.2}) {
    for (const Vec3& p : outline({.half = {76, 32}, .radius = 4, .steps = 1}, z)) body.push_back(p);
  }
  for (const auto& [inset, z] : {std::pair{3.0, 5.2}, std::pair{4.0, 9.0}}) {
    for (const Vec3& p :
         box_points({-76 + inset, -32 + inset, z}, {76 - inset, 32 - inset, z}, 0)) {
      block.push_back(p);
    }
  }
  return object_files("keyboard", {painted_part(surface, "plastic", top_texture(), 0.8)},
                      {hull_mm(body, "body"), hull_mm(block, "keys")});
}

}  // namespace probe::make
