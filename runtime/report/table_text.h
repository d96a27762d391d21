// The tables as files: comma-separated values, JSON, and LaTeX in the layout of the paper's tables.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/report/published.h"
#include "runtime/report/tables.h"

namespace probe::report {

enum class TableFormat : std::uint8_t { kCsv, kJson, kLatex };
std::optional<TableFormat> table_format(std::string_view name);  // "csv", "json", "latex"

// csv: the paper's layout, `policy,metric,avg,CATEGORY,...` in percent, then for each column its
//   count `COLUMN_k`, `COLUMN_n` and interval `COLUMN_low`, `COLUMN_high`; published tables follow
//   as rows without counts, their source in the last column. parse_published reads the percentages.
// json: {main, language, deltas, category_deltas, ...} with names in place of indices.
// latex: a document of booktabs tables: main table, language variation, other differences by
//   category. For a paper take a table and the two commands before the document begins.
// Every percentage has its count beside it.
std::string table_text(const Benchmark& benchmark, const Tables& tables,
                       const std::vector<PublishedTable>& published, TableFormat format);

}  // namespace probe::report
