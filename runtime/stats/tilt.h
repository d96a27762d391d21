// What the sums of exact_sum.h and deal.h have in common: a distribution of whole numbers is tilted
// until its mean lies where the tail begins, and is then summed from its Fourier transform, which
// repeats it with some period.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace probe::stats {

// A tilt of e^40 a step leaves nothing beside the largest sum.
inline constexpr double kLargestTilt = 40;

// A term whose logarithm is less than this adds nothing.
inline constexpr double kNoSize = -45;

// With less tilt than one standard deviation's, 1 / (1 - e^-t) is so sharp that the period would
// have to be longer; the mean of the tilted sum need not lie exactly where the tail begins.
inline double smallest_tilt(double variance) {
  return std::min(kLargestTilt, 1 / std::sqrt(std::max(variance, 1e-4)));
}

// A period after which a sum of independent numbers, each within `span`, comes back with less than
// e^-42: by Bernstein's inequality, P(|S - mean| >= x) <= 2 exp(-x^2 / (2 (variance + span x /
// 3))); and the tail's own weight e^(-tilt x) is as small.
inline std::int64_t quiet_period(double variance, double span, double tilt) {
  const double wide = 10 * std::sqrt(variance) + 30 * span;
  return static_cast<std::int64_t>(std::ceil(2 * wide + 42 / tilt));
}

// Where `f`, which does not fall, passes 0 between low and high; an end where it does not.
template <typename Function>
double rising_root(Function f, double low, double high) {
  for (int i = 0; i < 60 && low < high; ++i) {
    const double middle = (low + high) / 2;
    (f(middle) < 0 ? low : high) = middle;
  }
  return (low + high) / 2;
}

}  // namespace probe::stats
