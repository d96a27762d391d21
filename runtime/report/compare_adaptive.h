// Two runs of which at least one stops by what it finds: what may be said of them at any time.
#pragma once

#include <vector>

#include "runtime/base/result.h"
#include "runtime/report/benchmark.h"
#include "runtime/report/compare.h"

namespace probe::report {

// Starts, with all seeds, are won by either side (adaptive/decision.h), in the order in which they
// were run; adjusted after Holm over the metrics. Of a rule of each task the evidence is that of the
// end, which needs to know that each next task was chosen by what is stored. What holds for starts
// never tried, sizes and their intervals are left out, and said to be. Fails (kUsage) where nothing
// can be vouched for, with the reason.
Result<std::vector<AnytimeRow>> compare_at_any_time(const Benchmark& benchmark, int a, int b,
                                                    const std::vector<int>& metrics);

}  // namespace probe::report
