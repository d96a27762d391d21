#include "runtime/report/published.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>

#include "runtime/base/file.h"
#include "runtime/base/percent.h"
#include "runtime/base/printable.h"
#include "runtime/report/csv_cells.h"

namespace probe::report {
namespace {

std::optional<Percentage> percentage_of(std::string_view text) {
  std::string_view digits = text;
  if (!digits.empty() && digits.back() == '%')
    digits = trimmed(digits.substr(0, digits.size() - 1));
  Percentage percentage;
  percentage.text = text;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(),
                                            percentage.value, std::chars_format::fixed);
  if (error != std::errc() || end != digits.data() + digits.size()) return std::nullopt;
  if (!(percentage.value >= 0 && percentage.value <= 100)) return std::nullopt;
  const std::size_t point = digits.find('.');
  if (point != std::string_view::npos)
    percentage.decimals = static_cast<int>(digits.size() - point - 1);
  return percentage;
}

// Columns of our own CSV that are no percentages of a table.
bool is_beside(std::string_view column) {
  for (const std::string_view suffix : {"_k", "_n", "_low", "_high"}) {
    if (column.ends_with(suffix)) return true;
  }
  return column == "source";
}

constexpr std::size_t kLongestName = 1000;  // of a policy, bytes
// What a page shows, and a thousand times what a paper prints.
constexpr std::size_t kMostRows = 10'000, kMostColumns = 1000, kMostCells = 200'000;
constexpr std::size_t kMostBytes = std::size_t{64} << 20;

double percent(std::int64_t k, std::int64_t n) {
  return 100 * static_cast<double>(k) / static_cast<double>(n);
}

}  // namespace

Result<PublishedTable> parse_published(std::string_view csv, const std::string& source) {
  PublishedTable table;
  table.source = source;
  if (csv.substr(0, 3) == "\xef\xbb\xbf") csv.remove_prefix(3);
  std::set<std::pair<std::string, std::string>> seen;
  bool has_header = false;
  std::vector<bool> kept;  // by column after the first two
  std::size_t number = 0;
  while (!csv.empty()) {
    const std::size_t end = std::min(csv.find('\n'), csv.size());
    const std::string_view line = trimmed(csv.substr(0, end));
    csv.remove_prefix(std::min(end + 1, csv.size()));
    ++number;
    if (line.empty() || line[0] == '#') continue;
    const std::string where = fmt::format("{}:{}", source, number);
    std::vector<std::string> cells = csv_cells(line);
    if (!has_header) {
      if (cells.size() < 3 || cells[0] != "policy" || cells[1] != "metric") {
        return Failure{Fault::kUsage,
                       "a table of published numbers begins with `policy,metric,` and its columns, "
                       "as in policy,metric,avg,original,ood_source",
                       where};
      }
      for (std::size_t i = 2; i < cells.size(); ++i) {
        kept.push_back(!is_beside(cells[i]));
        if (!kept.back()) continue;
        if (std::find(table.columns.begin(), table.columns.end(), cells[i]) !=
            table.columns.end()) {
          return Failure{Fault::kUsage, fmt::format("column `{}` stands twice", cells[i]), where};
        }
        table.columns.push_back(cells[i]);
        if (table.columns.size() > kMostColumns) {
          return Failure{Fault::kUsage,
                         fmt::format("more than {} columns of percentages", kMostColumns), where};
        }
      }
      table.header_line = number;
      has_header = true;
      continue;
    }
    const std::size_t row_count = table.rows.size() + 1;
    if (row_count > kMostRows)
      return Failure{Fault::kUsage, fmt::format("more than {} rows of percentages", kMostRows),
                     where};
    if (row_count * table.columns.size() > kMostCells)
      return Failure{Fault::kUsage, fmt::format("more than {} cells of percentages", kMostCells),
                     where};
    if (cells.size() != kept.size() + 2) {
      return Failure{
          Fault::kUsage,
          fmt::format("{} cells where the first line has {}", cells.size(), kept.size() + 2),
          where};
    }
    PublishedRow row{printable(cells[0], kLongestName), cells[1], {}, number};
    if (!seen.emplace(row.policy, row.metric).second) {
      return Failure{Fault::kUsage, fmt::format("`{}`, `{}` stands twice", row.policy, row.metric),
                     where};
    }
    for (std::size_t i = 2; i < cells.size(); ++i) {
      if (!kept[i - 2]) continue;
      if (cells[i].empty() || cells[i] == "-") {
        row.cells.emplace_back();
        continue;
      }
      auto percentage = percentage_of(cells[i]);
      if (!percentage) {
        return Failure{Fault::kUsage,
                       fmt::format("`{}` under `{}` is no percentage from 0 to 100", cells[i],
                                   table.columns[row.cells.size()]),
                       where};
      }
      row.cells.push_back(std::move(percentage));
    }
    table.rows.push_back(std::move(row));
  }
  if (table.rows.empty()) return Failure{Fault::kUsage, "holds no row of numbers", source};
  return table;
}

Result<PublishedTable> read_published(const std::string& path) {
  PROBE_ASSIGN(const std::string text,
               read_file(path, {.most = kMostBytes, .code = Fault::kUsage, .only_begin = false}));
  return parse_published(text, path);
}

std::optional<std::string> impossible(const Percentage& percentage, std::int64_t tasks,
                                      std::int64_t per_task) {
  const std::int64_t n = tasks * per_task;
  if (n <= 0) return std::nullopt;
  const NearestCounts found = nearest_counts(percentage.value, percentage.decimals, n);
  if (found.fits) return std::nullopt;
  const int digits = percentage.decimals;
  std::string text =
      fmt::format("{} % is no count of {} episodes; nearest: {} ({} %)", percentage.value, n,
                  found.below, decimal_text(percent(found.below, n), digits + 1));
  if (found.above != found.below) {
    text += fmt::format(" and {} ({} %)", found.above,
                        decimal_text(percent(found.above, n), digits + 1));
  }
  for (const std::int64_t other : {tasks + 1, tasks - 1, tasks + 2}) {
    if (other <= 0) continue;
    const NearestCounts would =
        nearest_counts(percentage.value, percentage.decimals, other * per_task);
    if (!would.fits) continue;
    text += fmt::format("; {} tasks could give it: {} of {}", other, would.below, other * per_task);
    break;
  }
  return text;
}

}  // namespace probe::report
