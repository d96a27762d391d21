// What makes one benchmark of all that was loaded: labels, the order of metrics, which tasks stay
// and which are compared, and notes on what is missing.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "runtime/report/joined_plans.h"

namespace probe::report {

inline constexpr std::size_t kLongestText = 1000;  // of a name or reason of a folder, bytes
inline constexpr std::size_t kNamed = 3;           // before the rest is only counted

// Once, when all folders are in. `sets`: LoadOptions::sets.
void arrange(Benchmark& benchmark, const JoinedPlans& plans, const std::vector<std::string>& sets);

}  // namespace probe::report
