// Capital letters as strokes, for labels: how far a point is from the ink. Knows nothing of images.
#pragma once

#include <string_view>

#include "assets/make/solid.h"

namespace probe::make {

// Distance from the nearest stroke's centre line, in letter heights. `at` is in letter heights from
// the text's lower left corner, y up; letters are 0.72 wide and 0.92 apart, an I is narrower.
// Known: A C E F I J L O U Z.
double stroke_distance(std::string_view text, const Vec2& at);
double text_width(std::string_view text);

}  // namespace probe::make
