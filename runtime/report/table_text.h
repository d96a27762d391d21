// The tables as files: comma-separated values, JSON, and LaTeX in the layout of the paper's tables.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/report/published.h"
#include "runtime/report/tables.h"

namespace probe::report {

enum class TableFormat : std::uint8_t { kCsv, kDifferencesCsv, kJson, kLatex };

// What a user calls them.
struct TableFormatName {
  std::string_view name;
  TableFormat format;
};
inline constexpr std::array<TableFormatName, 4> kTableFormats = {
    {{"csv", TableFormat::kCsv},
     {"csv-differences", TableFormat::kDifferencesCsv},
     {"json", TableFormat::kJson},
     {"latex", TableFormat::kLatex}}};
std::optional<TableFormat> table_format(std::string_view name);

// csv: the paper's layout, `policy,metric,avg,CATEGORY,...` in percent, then for each column its
//   count `COLUMN_k`, `COLUMN_n` and interval `COLUMN_low`, `COLUMN_high`; published tables follow
//   as rows without counts, their source in the last column. parse_published reads the percentages.
// csv-differences: a row a difference, both questions beside each other: variants against their
//   baselines by category and by task, policies in pairs; see differences_csv.cpp for the columns.
// json: {main, language, deltas, category_deltas, ...} with names in place of indices.
// latex: a document of booktabs tables: main table, policies in pairs, language variation, other
//   differences by category. For a paper take a table and the two commands before the document
//   begins.
// Models that were asked stand in the same tables, behind the policies, with families of questions
// for metrics: what is right in every order of the options. Beside it stand the rates of
// kRateKinds: in csv as metrics "FAMILY (blind)", in json as `models.rates`, in latex in a table.
// json has `models` and `knows`, csv-differences lines of kind knows-goes, latex a table. Every
// percentage has its count beside it, but for what is computed.
std::string table_text(const Benchmark& benchmark, const Tables& tables,
                       const std::vector<PublishedTable>& published, TableFormat format);

}  // namespace probe::report
