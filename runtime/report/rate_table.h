// Published rates as a table says them, one figure a row.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/base/result.h"

namespace probe::report {

// One row of the table, a rate from 0 to 1 or a figure of agreement.
struct PublishedFigure {
  std::string source, protocol, metric, policy, task, subtask;
  double value = 0;
  int decimals = 0;   // digits behind the point
  double trials = 0;  // of which it is the rate; 0: not said
  std::size_t line = 0;
};

struct RateTable {
  std::string file;
  std::vector<PublishedFigure> figures;  // in the order of the file
  std::vector<std::string> unread;       // rows whose value is no number, such as a range
};

// A CSV of one figure a row, with the columns source, protocol, metric, policy, task, subtask and
// value in any order. `trials_per_published_protocol` (or `trials`) is read where it is there,
// other columns are passed over. Fails (kUsage, where = file:line) on a column that is missing or
// there twice, a row of another length, a line break in a cell, a success_rate that is not from 0
// to 1, a figure that the same source gives twice, and UTF-16. What `column_of` calls alike is one
// column.
Result<RateTable> parse_rate_table(std::string_view csv, const std::string& file);

// The protocol of real rates.
inline constexpr std::string_view kReal = "real";
inline bool is_rate(const PublishedFigure& figure) { return figure.metric == "success_rate"; }

// What a column is called: task and subtask joined by `_`, the task alone where the subtask is
// `average` or none.
std::string column_of(const std::string& task, const std::string& subtask);
// Of a figure, or of a row of agreements.
std::string column_of(const auto& of) { return column_of(of.task, of.subtask); }
// "RT-1-X, visual_matching, drawer_open"
std::string name_of(const PublishedFigure& figure);

}  // namespace probe::report
