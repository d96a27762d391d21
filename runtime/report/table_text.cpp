#include "runtime/report/table_text.h"

#include "runtime/report/table_parts.h"

namespace probe::report {

std::optional<TableFormat> table_format(std::string_view name) {
  for (const TableFormatName& known : kTableFormats) {
    if (known.name == name) return known.format;
  }
  return std::nullopt;
}

std::string table_text(const Benchmark& benchmark, const Tables& tables,
                       const std::vector<PublishedTable>& published, TableFormat format) {
  const std::optional<AskedTables> asked = make_asked_tables(benchmark);
  const TablesToPrint print{benchmark, tables, published, asked ? &*asked : nullptr};
  switch (format) {
    case TableFormat::kCsv:
      return tables_csv(print);
    case TableFormat::kDifferencesCsv:
      return differences_csv(print);
    case TableFormat::kJson:
      return tables_json(print);
    case TableFormat::kLatex:
      return tables_latex(print);
  }
  return "";
}

}  // namespace probe::report
