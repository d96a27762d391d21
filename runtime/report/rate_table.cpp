#include "runtime/report/rate_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>

#include "runtime/base/printable.h"
#include "runtime/report/csv_cells.h"

namespace probe::report {
namespace {

constexpr std::size_t kLongest = 200;         // of a cell in messages, bytes
constexpr std::size_t kMostFigures = 10'000;  // far more than any paper; work grows with its square
constexpr std::size_t kLongestNumber = 20;    // of which a double holds 15 digits

enum Column : std::size_t {
  kSource,
  kProtocol,
  kMetric,
  kPolicy,
  kTask,
  kSubtask,
  kValue,
  kNeeded
};
constexpr std::array<std::string_view, kNeeded> kColumns = {
    "source", "protocol", "metric", "policy", "task", "subtask", "value"};
constexpr std::array<std::string_view, 2> kTrials = {"trials_per_published_protocol", "trials"};

std::optional<double> number_of(std::string_view text) {
  double value = 0;
  const auto [end, error] =
      std::from_chars(text.data(), text.data() + text.size(), value, std::chars_format::fixed);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
    return std::nullopt;
  return value;
}

std::string_view first_line(std::string_view csv) {
  if (csv.starts_with("\xef\xbb\xbf")) csv.remove_prefix(3);
  return trimmed(csv.substr(0, csv.find('\n')));
}

bool has_open_quote(std::string_view line) { return std::ranges::count(line, '"') % 2 != 0; }

// Where the columns stand, by the first line.
struct Header {
  std::size_t size = 0;
  std::array<std::size_t, kNeeded> at{};
  std::optional<std::size_t> trials;
};

Result<Header> read_header(std::string_view line, const std::string& where) {
  if (line.find('\r') != std::string_view::npos)
    return Failure{Fault::kUsage, "lines end in a carriage return alone: save it with line feeds",
                   where};
  const std::vector<std::string> names = csv_cells(line);
  const auto index_of = [&](std::string_view column) -> Result<std::optional<std::size_t>> {
    const auto found = std::ranges::find(names, column);
    if (found == names.end()) return std::optional<std::size_t>();
    if (std::ranges::count(names, column) > 1)
      return Failure{Fault::kUsage, fmt::format("the column `{}` is here twice", column), where};
    return std::optional(static_cast<std::size_t>(found - names.begin()));
  };
  Header header;
  header.size = names.size();
  for (std::size_t c = 0; c < kNeeded; ++c) {
    PROBE_ASSIGN(const auto at, index_of(kColumns[c]));
    if (!at)
      return Failure{Fault::kUsage,
                     fmt::format("a table of rates has the columns source, protocol, metric, "
                                 "policy, task, subtask and value, and no `{}` is here",
                                 kColumns[c]),
                     where};
    header.at[c] = *at;
  }
  for (const std::string_view name : kTrials) {
    PROBE_ASSIGN(const auto at, index_of(name));
    if (!header.trials) header.trials = at;
  }
  return header;
}

// What says of which rate a row is, as it is written.
using Key = std::array<std::string, kValue>;

Result<Key> key_of(const Header& header, const std::vector<std::string>& cells,
                   const std::string& where) {
  Key key;
  for (std::size_t c = 0; c < kValue; ++c) {
    key[c] = cells[header.at[c]];
    if (key[c].empty() && c != kSource && c != kSubtask)
      return Failure{Fault::kUsage, fmt::format("a row has no {}", kColumns[c]), where};
  }
  return key;
}

// A source gives one figure a column, however it divides the column's name into task and subtask.
Key column_key(const Key& key) {
  Key joined = key;
  joined[kTask] = column_of(key[kTask], key[kSubtask]);
  joined[kSubtask].clear();
  return joined;
}

PublishedFigure figure_of(const Key& key, std::size_t line) {
  const auto shown = [&](Column column) { return printable(key[column], kLongest); };
  PublishedFigure figure;
  figure.source = shown(kSource);
  figure.protocol = shown(kProtocol);
  figure.metric = shown(kMetric);
  figure.policy = shown(kPolicy);
  figure.task = shown(kTask);
  figure.subtask = shown(kSubtask);
  figure.line = line;
  return figure;
}

Status put_value(double value, const std::string& written, const std::string& where,
                 PublishedFigure& figure) {
  const auto refused = [&](const char* what) {
    return Failure{Fault::kUsage, fmt::format("`{}` {}", printable(written, kLongest), what),
                   where};
  };
  if (is_rate(figure) && !(value >= 0 && value <= 1)) return refused("is no rate from 0 to 1");
  if (written.size() > kLongestNumber) return refused("has more digits than a number holds");
  const std::size_t point = written.find('.');
  figure.value = value;
  figure.decimals = point == std::string::npos ? 0 : static_cast<int>(written.size() - point - 1);
  return {};
}

Status put_trials(const std::string& written, const std::string& where, PublishedFigure& figure) {
  if (written.empty()) return {};
  const auto count = number_of(written);
  if (!count || *count < 1 || *count > 1e9 || *count != std::floor(*count))
    return Failure{Fault::kUsage,
                   fmt::format("`{}` is no number of trials", printable(written, kLongest)), where};
  figure.trials = *count;
  return {};
}

}  // namespace

std::string column_of(const std::string& task, const std::string& subtask) {
  return subtask.empty() || subtask == "average" ? task : task + "_" + subtask;
}

std::string name_of(const PublishedFigure& figure) {
  return fmt::format("{}, {}, {}", figure.policy, figure.protocol, column_of(figure));
}

Result<RateTable> parse_rate_table(std::string_view csv, const std::string& file) {
  RateTable table{file, {}, {}};
  if (csv.starts_with("\xff\xfe") || csv.starts_with("\xfe\xff") ||
      first_line(csv).find('\0') != std::string_view::npos)
    return Failure{Fault::kUsage, "is in UTF-16: save it as UTF-8", file};
  PROBE_ASSIGN(const Header header, read_header(first_line(csv), file + ":1"));
  std::map<Key, std::size_t> lines;  // of the figures
  std::size_t number = 0;
  while (!csv.empty()) {
    const std::size_t end = std::min(csv.find('\n'), csv.size());
    const std::string_view line = trimmed(csv.substr(0, end));
    csv.remove_prefix(std::min(end + 1, csv.size()));
    if (++number == 1 || line.empty() || line[0] == '#') continue;
    const std::string where = fmt::format("{}:{}", file, number);
    if (has_open_quote(line))
      return Failure{Fault::kUsage, "a quote is not closed on its line", where};
    const std::vector<std::string> cells = csv_cells(line);
    if (cells.size() != header.size)
      return Failure{Fault::kUsage,
                     fmt::format("{} cells where the first line has {}", cells.size(), header.size),
                     where};
    PROBE_ASSIGN(const Key key, key_of(header, cells, where));
    PublishedFigure figure = figure_of(key, number);
    const std::string& written = cells[header.at[kValue]];
    const auto value = number_of(written);
    if (!value) {
      table.unread.push_back(fmt::format("{}: {}: `{}` is no number", where, name_of(figure),
                                         printable(written, kLongest)));
      continue;
    }
    PROBE_TRY(put_value(*value, written, where, figure));
    if (table.figures.size() >= kMostFigures)
      return Failure{Fault::kUsage, fmt::format("more than {} figures", kMostFigures), where};
    if (const auto [first, is_new] = lines.try_emplace(column_key(key), number); !is_new)
      return Failure{Fault::kUsage,
                     fmt::format("{}: {} of this source is on line {} already", name_of(figure),
                                 figure.metric, first->second),
                     where};
    if (header.trials) PROBE_TRY(put_trials(cells[*header.trials], where, figure));
    table.figures.push_back(std::move(figure));
  }
  if (table.figures.empty()) return Failure{Fault::kUsage, "holds no row of figures", file};
  return table;
}

}  // namespace probe::report
