// What axes and pairs of them explain of the variance of the outcome. A part of axes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "runtime/search/method/draws.h"
#include "runtime/search/method/parts.h"
#include "runtime/stats/intervals.h"

namespace probe::search {

using AxisPair = std::pair<std::size_t, std::size_t>;

struct AxisShares {
  double first = 0, total = 0;  // 0..1
  stats::Interval first_interval, total_interval;
};

struct Shares {
  std::vector<AxisShares> axes;
  // Beyond what the two explain alone, 0..1; none where there are fewer than two trials to a cell.
  std::vector<std::optional<double>> pairs;
};

// Of axes that are cut into `parts`: Sobol's indices of first order by epsilon squared (Kelley
// 1935, PNAS 21:554), (between - (groups - 1) within) / total, which chance alone does not raise; a
// pair's in the same way, less those of its two; the total of an axis with those of `pairs` that it
// is in. Intervals of 95 % by resampling trials.
Shares shares_of(const std::vector<Parts>& parts, const std::vector<AxisPair>& pairs,
                 const std::vector<std::uint8_t>& failed, int resamples, Draws draws);

}  // namespace probe::search
