#include "runtime/report/published_match.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "runtime/base/printable.h"
#include "runtime/base/spelling.h"

namespace probe::report {
namespace {

constexpr std::size_t kShown = 100;  // bytes of a name in a message

// The names that each of our columns goes by.
std::vector<std::vector<std::string>> names_of_columns(const Benchmark& benchmark) {
  std::vector<std::vector<std::string>> names = {{"avg", "all"}};
  for (const Category& c : benchmark.categories) names.push_back({c.name, c.label});
  return names;
}

}  // namespace

std::vector<std::optional<std::size_t>> matched_columns(const Benchmark& benchmark,
                                                        const PublishedTable& table) {
  std::vector<std::optional<std::size_t>> columns;
  for (const auto& names : names_of_columns(benchmark)) {
    columns.emplace_back();
    for (const std::string& name : names) {
      const auto at = std::find(table.columns.begin(), table.columns.end(), name);
      if (columns.back() || at == table.columns.end()) continue;
      columns.back() = static_cast<std::size_t>(at - table.columns.begin());
    }
  }
  return columns;
}

std::vector<Note> unmatched(const Benchmark& benchmark, const PublishedTable& table) {
  std::vector<Note> notes;
  const auto columns = matched_columns(benchmark, table);
  std::vector<std::string> known;
  for (const auto& names : names_of_columns(benchmark))
    known.insert(known.end(), names.begin(), names.end());
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    if (std::find(columns.begin(), columns.end(), std::optional(c)) != columns.end()) continue;
    const std::string& name = table.columns[c];
    const bool twice = std::find(known.begin(), known.end(), name) != known.end();
    notes.push_back(
        {"warn", fmt::format("{}:{}: column `{}` {}; it is left out", table.source,
                             table.header_line, printable(name, kShown),
                             twice ? "is another name of a column that is there"
                                   : "is no category of the runs" + did_you_mean(name, known))});
  }
  std::vector<std::string> metrics;
  for (const Metric& metric : benchmark.metrics) {
    if (metric.truth) metrics.push_back(metric.name);
  }
  std::set<std::string> told;
  for (const PublishedRow& row : table.rows) {
    if (benchmark.find_metric(row.metric) != kAbsent || !told.insert(row.metric).second) continue;
    notes.push_back({"warn", fmt::format("{}:{}: metric `{}` is none of the runs{}; its rows stand "
                                         "beside none of ours",
                                         table.source, row.line, printable(row.metric, kShown),
                                         did_you_mean(row.metric, metrics))});
  }
  return notes;
}

}  // namespace probe::report
