#include "assets/make/lettering.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "assets/make/image.h"
#include "runtime/base/check.h"

namespace probe::make {
namespace {

using Stroke = std::vector<Vec2>;

constexpr double kWidth = 0.72, kNarrow = 0.1, kGap = 0.30;

std::vector<Stroke> strokes_of(char letter) {
  const Stroke bowl{{0.70, 0.80}, {0.56, 0.95}, {0.36, 1.0}, {0.16, 0.93}, {0.04, 0.75}, {0.0, 0.5},
                    {0.04, 0.25}, {0.16, 0.07}, {0.36, 0.0}, {0.56, 0.05}, {0.70, 0.20}};
  switch (letter) {
    case 'A':
      return {{{0, 0}, {0.36, 1}, {0.72, 0}}, {{0.14, 0.34}, {0.58, 0.34}}};
    case 'C':
      return {bowl};
    case 'E':
      return {{{0.66, 1}, {0, 1}, {0, 0}, {0.66, 0}}, {{0, 0.52}, {0.56, 0.52}}};
    case 'F':
      return {{{0.66, 1}, {0, 1}, {0, 0}}, {{0, 0.5}, {0.56, 0.5}}};
    case 'I':
      return {{{0.05, 0}, {0.05, 1}}};
    case 'J':
      return {{{0.6, 1}, {0.6, 0.25}, {0.5, 0.06}, {0.3, 0}, {0.1, 0.06}, {0.02, 0.25}}};
    case 'L':
      return {{{0, 1}, {0, 0}, {0.64, 0}}};
    case 'O': {
      Stroke ring = bowl;
      ring.insert(ring.end(), {{0.72, 0.5}, {0.70, 0.80}});
      return {ring};
    }
    case 'U':
      return {{{0, 1}, {0, 0.28}, {0.1, 0.08}, {0.34, 0}, {0.58, 0.08}, {0.68, 0.28}, {0.68, 1}}};
    case 'Z':
      return {{{0.02, 1}, {0.68, 1}, {0, 0}, {0.7, 0}}};
    default:
      return {};
  }
}

double width_of(char letter) { return letter == 'I' ? kNarrow : kWidth; }

double segment_distance(const Vec2& p, const Vec2& a, const Vec2& b) {
  const Vec2 along = b - a, to = p - a;
  const double t = clamp01(to.dot(along) / along.squaredNorm());
  return (to - t * along).norm();
}

}  // namespace

double stroke_distance(std::string_view text, const Vec2& at) {
  double nearest = 1e9, left = 0;
  for (const char letter : text) {
    const std::vector<Stroke> strokes = strokes_of(letter);
    PROBE_CHECK(!strokes.empty(), "a label uses a letter that has no strokes");
    for (const Stroke& stroke : strokes) {
      for (std::size_t i = 1; i < stroke.size(); ++i) {
        const Vec2 shift(left, 0);
        nearest = std::min(nearest, segment_distance(at, stroke[i - 1] + shift, stroke[i] + shift));
      }
    }
    left += width_of(letter) + kGap;
  }
  return nearest;
}

double text_width(std::string_view text) {
  double width = -kGap;
  for (const char letter : text) width += width_of(letter) + kGap;
  return width;
}

}  // namespace probe::make
