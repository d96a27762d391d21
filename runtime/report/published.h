// Other people's numbers: a table of percentages in the layout of the paper's main table, and
// whether any number of episodes can give them. Knows nothing of runs.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/base/result.h"

namespace probe::report {

// A percentage as it was written.
struct Percentage {
  double value = 0;  // 0..100
  int decimals = 0;  // digits behind the point
  std::string text;
};

struct PublishedRow {
  std::string policy, metric;
  std::vector<std::optional<Percentage>> cells;  // by column; nothing: the cell is empty or "-"
  std::size_t line = 0;
};

struct PublishedTable {
  std::string source;                // the file
  std::vector<std::string> columns;  // "avg", "original", "ood_source" ...
  std::vector<PublishedRow> rows;
  std::size_t header_line = 0;
};

// `policy,metric,COLUMN,...` and a line a policy and metric, percentages with or without "%"; the
// counts and intervals of our own tables are passed over.
// Fails (kUsage, where = source:line) on another layout, a cell that is no percentage, a row or
// column that stands twice, more than 10,000 rows, 1000 columns or 200,000 cells.
Result<PublishedTable> parse_published(std::string_view csv, const std::string& source);
Result<PublishedTable> read_published(const std::string& path);

// Why the percentage cannot be one of `tasks` tasks with `per_task` episodes each, in a sentence
// with the nearest possible ones and, if there is one near, a number of tasks that would give it;
// nothing when it can.
std::optional<std::string> impossible(const Percentage& percentage, std::int64_t tasks,
                                      std::int64_t per_task);

}  // namespace probe::report
