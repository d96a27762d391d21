// Two boundary searches over one text and space: the tolerances of each side beside one another.
#pragma once

#include <string>
#include <vector>

#include "runtime/base/json.h"
#include "runtime/base/result.h"
#include "runtime/report/search_findings.h"

namespace probe::report {

struct ComparedSide {
  std::optional<Tolerance> a, b;  // of one axis and way; none: the search has not had it
  std::string verdict;            // what may be said of the two
};

struct ComparedSearches {
  SearchFindings a, b;
  std::vector<ComparedSide> sides;
};

// Fails (kUsage) on searches by another method, over another text, space or task, naming both; and
// as read_findings does. Intervals are of 95 % each, so of two that do not overlap no more is said
// than that.
Result<ComparedSearches> compare_searches(const std::string& a, const std::string& b);

std::string to_text(const ComparedSearches& compared);
Json to_json(const ComparedSearches& compared);

}  // namespace probe::report
