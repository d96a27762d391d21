// How much of each change policies stand: a row a way along an axis, from the task's own value to
// the end of the space, policies below one another.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "runtime/report/search_findings.h"

namespace probe::report {

// Boundary searches of one text and space, whose sides are the same.
struct ToleranceGroup {
  std::vector<const SearchFindings*> searches;
};
// In the order of the searches.
std::vector<ToleranceGroup> tolerance_groups(std::span<const SearchFindings> searches);

// What the page calls a search's policy: its name, with the folder where two have one name.
std::string policy_label(std::span<const SearchFindings> searches, const SearchFindings& one);

// As HTML; `all` is for labels. A figure, and a table with the same behind it.
std::string tolerance_chart(const ToleranceGroup& group, std::span<const SearchFindings> all);

}  // namespace probe::report
