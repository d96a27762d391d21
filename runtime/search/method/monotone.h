// Whether success could fall all along an axis, given what was seen. A part of boundary.
#pragma once

#include <cstdint>
#include <span>

#include "runtime/stats/intervals.h"

namespace probe::search {

// The p value of "success nowhere rises with the level": the largest likelihood ratio by which one
// run of levels has more success than the run right before it, against the same in bootstrap draws
// from the isotonic fit (pool adjacent violators: Barlow, Bartholomew, Bremner and Brunk 1972),
// each pool's rate drawn half a trial towards 1/2. Sequential Monte Carlo, at most 999 draws (Besag
// and Clifford 1991, Biometrika 78:301). `successes` by level; levels that were not tried have n =
// 0.
double monotone_p(std::span<const stats::Count> successes, std::uint64_t seed);

}  // namespace probe::search
