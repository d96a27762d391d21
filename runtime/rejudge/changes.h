// How often a metric says something else under another plan, over episodes that are valid under
// both.
#pragma once

#include <string>
#include <vector>

#include "runtime/store/results.h"

namespace probe::rejudge {

struct MetricChange {
  std::string name;
  bool is_bool = true;
  int before = 0, after = 0;            // episodes at which it is true
  int lost = 0, gained = 0;             // true before and not after; not before and true after
  int changed = 0;                      // episodes with another value
  int episodes = 0;                     // at which both plans have it
  int only_before = 0, only_after = 0;  // episodes at which one of them has it
  double mean_before = 0, mean_after = 0;
};

// One more episode. Metrics are listed in the order in which they are met first, `before` first.
void count_changes(std::vector<MetricChange>& changes, const store::ResultRow& before,
                   const store::ResultRow& after);

}  // namespace probe::rejudge
