// An axis as tests and shares see it: cut into parts. A part of axes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "runtime/search/method/axes.h"

namespace probe::search {

// One axis as the tests see it: a part for each trial, and the ways to cut it in two.
struct Parts {
  int count = 1;
  std::vector<std::uint8_t> of;  // a trial
  // A cut's further side is one part, or of an ordered axis all parts from it on; the first cut is
  // at part first_cut.
  bool is_ordered = true;
  std::size_t first_cut = 1;
  std::vector<Side> sides;  // the further side of each cut
};

// Axis number `at` of `points`: continuous axes in eight equal parts, counts in eight at most,
// choices in their options.
Parts parts_of(const Axis& axis, std::span<const Point> points, std::size_t at);
// How many that are.
int part_count(const Axis& axis);

Side other_side(Side side);

}  // namespace probe::search
