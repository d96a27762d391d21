// The main table as comma-separated values.
#include <fmt/format.h>

#include "runtime/base/csv.h"
#include "runtime/base/percent.h"
#include "runtime/report/published_match.h"
#include "runtime/report/table_parts.h"

namespace probe::report {
namespace {

std::string csv_counts(const std::optional<Estimate>& cell) {
  if (!cell) return ",,,,";
  return fmt::format(",{},{},{},{}", cell->count.k, cell->count.n,
                     decimal_text(100 * cell->interval.low, 1),
                     decimal_text(100 * cell->interval.high, 1));
}

std::string csv_rows(const Benchmark& benchmark, const Tables& tables) {
  std::string text;
  for (const MainRow& row : tables.main) {
    const auto cells = cells_of(row);
    text += csv_cell(policy_label(benchmark, row.policy)) + "," +
            csv_cell(metric_name(benchmark, row.metric));
    for (const auto& cell : cells)
      text += "," + (cell ? rate_text(*cell) : "");
    for (const auto& cell : cells) text += csv_counts(cell);
    text += ",measured\n";
  }
  return text;
}

std::string csv_rates(const Benchmark& benchmark, const AskedTables& asked) {
  std::string text;
  for (const RateRow& row : asked.rates) {
    text += csv_cell(benchmark.models[static_cast<std::size_t>(row.model)].label) + "," +
            csv_cell(fmt::format("{} ({})", row.question, row.kind->name));
    for (const auto& cell : row.cells)
      text += "," + (cell ? decimal_text(100 * cell->share, 1) : "");
    for (const auto& cell : row.cells) text += csv_counts(cell ? cell->counted : std::nullopt);
    text += row.kind->is_computed ? ",computed\n" : ",measured\n";
  }
  return text;
}

}  // namespace

std::string tables_csv(const TablesToPrint& print) {
  const Benchmark& benchmark = print.benchmark;
  const std::vector<std::string> names = column_names(benchmark);
  std::string text = "policy,metric";
  for (const std::string& name : names) text += "," + csv_cell(name);
  for (const std::string& name : names) {
    for (const char* part : {"k", "n", "low", "high"})
      text += "," + csv_cell(fmt::format("{}_{}", name, part));
  }
  text += ",source\n";
  text += csv_rows(benchmark, print.tables);
  if (print.asked != nullptr) {
    text += csv_rows(print.asked->benchmark, print.asked->tables);
    text += csv_rates(benchmark, *print.asked);
  }
  for (const PublishedTable& table : print.published) {
    const auto columns_of = matched_columns(benchmark, table);
    for (const PublishedRow& row : table.rows) {
      text += csv_cell(row.policy) + "," + csv_cell(row.metric);
      for (std::size_t c = 0; c < names.size(); ++c) {
        const auto cell = published_cell(row, columns_of[c]);
        text += "," + (cell ? csv_cell(cell->text) : "");
      }
      for (std::size_t c = 0; c < names.size(); ++c) text += ",,,,";
      text += "," + csv_cell("published: " + table.source) + "\n";
    }
  }
  return text;
}

}  // namespace probe::report
