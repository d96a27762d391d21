// Which points the rounds of a search left out, and why: rounds/*/points.csv.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/report/search_findings.h"

namespace probe::report {

// Rows of comma-separated values (RFC 4180), with line breaks inside quotes.
std::vector<std::vector<std::string>> csv_rows(std::string_view text);

// Of all rounds, the commonest first. A point of several rounds counts once; those that only prove
// others are none. A note names a table that cannot be read.
void read_left_out(const std::string& folder, std::vector<LeftOutReason>& reasons,
                   std::vector<std::string>& notes);

// The round whose points are those, the last of several; empty: none. Then the folder's path.
std::string round_with(const std::string& folder, const std::string& point);

}  // namespace probe::report
