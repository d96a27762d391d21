// What the formats of table_text.h have in common: what columns, rows and cells are called.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "runtime/report/asked_tables.h"
#include "runtime/report/published.h"
#include "runtime/report/tables.h"

namespace probe::report {

// The paper calls the tasks without a baseline "original".
inline std::string column_name(const Benchmark& benchmark, std::size_t category) {
  const Category& c = benchmark.categories[category];
  return c.label == "original" ? c.label : c.name;
}

inline std::vector<std::string> column_names(const Benchmark& benchmark) {
  std::vector<std::string> names = {"avg"};
  for (std::size_t c = 0; c < benchmark.categories.size(); ++c)
    names.push_back(column_name(benchmark, c));
  return names;
}

inline std::vector<std::optional<Estimate>> cells_of(const MainRow& row) {
  std::vector<std::optional<Estimate>> cells = {row.all};
  cells.insert(cells.end(), row.cells.begin(), row.cells.end());
  return cells;
}

inline const std::string& policy_label(const Benchmark& benchmark, int policy) {
  return benchmark.policies[static_cast<std::size_t>(policy)].label;
}
inline const std::string& metric_name(const Benchmark& benchmark, int metric) {
  return benchmark.metrics[static_cast<std::size_t>(metric)].name;
}

// The published percentage of one of our columns; nothing when that table has none.
inline std::optional<Percentage> published_cell(const PublishedRow& row,
                                                const std::optional<std::size_t>& column) {
  return column ? row.cells[*column] : std::nullopt;
}

// All that a format prints.
struct TablesToPrint {
  const Benchmark& benchmark;
  const Tables& tables;
  const std::vector<PublishedTable>& published;
  const AskedTables* asked;  // null: no model was asked
};

std::string tables_csv(const TablesToPrint& print);
std::string tables_json(const TablesToPrint& print);
std::string tables_latex(const TablesToPrint& print);
std::string differences_csv(const TablesToPrint& print);

}  // namespace probe::report
