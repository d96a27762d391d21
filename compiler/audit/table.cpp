#include "compiler/audit/table.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <vector>

#include "runtime/base/percent.h"

namespace probe::audit {
namespace {

constexpr std::size_t kMostTasks = 100;  // of a category that would explain a column

struct Percentage {
  double value = 0;
  int decimals = 0;
};

struct Column {
  std::string name;
  std::vector<Percentage> numbers;
};

std::vector<std::string_view> split(std::string_view text, char at) {
  std::vector<std::string_view> out;
  while (true) {
    const std::size_t end = text.find(at);
    out.push_back(text.substr(0, end));
    if (end == std::string_view::npos) return out;
    text.remove_prefix(end + 1);
  }
}

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlank = " \t\r\"";
  const std::size_t from = text.find_first_not_of(kBlank);
  if (from == std::string_view::npos) return {};
  return text.substr(from, text.find_last_not_of(kBlank) - from + 1);
}

std::optional<Percentage> read_percentage(std::string_view cell) {
  Percentage out;
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), out.value);
  if (error != std::errc() || end != cell.data() + cell.size()) return std::nullopt;
  if (!(out.value >= 0 && out.value <= 100)) return std::nullopt;
  const std::size_t point = cell.find('.');
  out.decimals = point == std::string_view::npos ? 0 : static_cast<int>(cell.size() - point - 1);
  return out;
}

// Cells that are no percentage, as names are, belong to nothing.
std::vector<Column> read_columns(std::string_view text) {
  std::vector<Column> columns;
  bool first = true;
  for (const std::string_view line : split(text, '\n')) {
    if (trimmed(line).empty() || line.front() == '#') continue;
    const auto cells = split(line, ',');
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const std::string_view cell = trimmed(cells[i]);
      if (first) {
        columns.push_back({std::string(cell), {}});
      } else if (i < columns.size()) {
        if (const auto number = read_percentage(cell)) columns[i].numbers.push_back(*number);
      }
    }
    first = false;
  }
  std::erase_if(columns, [](const Column& column) { return column.numbers.empty(); });
  return columns;
}

std::size_t misfits(const Column& column, std::size_t episodes) {
  return static_cast<std::size_t>(
      std::count_if(column.numbers.begin(), column.numbers.end(),
                    [&](const Percentage& number) {
                      return !nearest_counts(number.value, number.decimals,
                                             static_cast<std::int64_t>(episodes))
                                  .fits;
                    }));
}

// The plan keeps no place of a set.
Place place_of_set(const Compilation& compilation, std::string_view name) {
  for (std::uint32_t i = 0; i < compilation.sources.size(); ++i) {
    const SourceFile& file = compilation.sources.file(FileId{i});
    std::uint32_t number = 0;
    for (std::string_view line : split(file.text(), '\n')) {
      ++number;
      const std::size_t indent = line.find_first_not_of(' ');
      if (indent == std::string_view::npos || !line.substr(indent).starts_with("set ")) continue;
      line = line.substr(indent + 4);
      const std::size_t equals = line.find('=');
      if (equals == std::string_view::npos || trimmed(line.substr(0, equals)) != name) continue;
      return {file.name(), number, static_cast<std::uint32_t>(indent + 1)};
    }
  }
  return {};
}

std::optional<std::uint32_t> find_set(const plan::Plan& plan, std::string_view name) {
  for (std::uint32_t i = 0; i < plan.sets().size(); ++i)
    if (plan.text(plan.sets()[i].name) == name) return i;
  return std::nullopt;
}

}  // namespace

Status check_table(Audit& audit, const Compilation& compilation, const plan::Plan& plan,
                   std::uint32_t suite, std::string_view text, const std::string& name) {
  const plan::SuiteRecord& record = plan.suites()[suite];
  const auto members = plan.members(record);
  const std::size_t seeds = std::max<std::size_t>(1, record.seeds.count);
  bool any = false;
  for (const Column& column : read_columns(text)) {
    const auto set = find_set(plan, column.name);
    if (!set) {
      audit.unchecked.push_back(column.name);
      continue;
    }
    any = true;
    Finding finding;
    std::size_t episodes = 0;
    for (const std::uint32_t task : plan::slice_of(plan.tables().list, plan.sets()[*set].members)) {
      if (std::find(members.begin(), members.end(), task) == members.end()) continue;
      finding.tasks.emplace_back(plan.text(plan.tasks()[task].name));
      episodes += seeds * plan.episodes(record, task).size();
    }
    const std::size_t tasks = finding.tasks.size();
    const std::size_t odd = episodes == 0 ? 0 : misfits(column, episodes);
    if (odd == 0) continue;
    finding.kind = Kind::kTable;
    finding.message = fmt::format(
        "{} of the {} percentages of `{}` in {} are no averages over its {} tasks ({} episodes)",
        odd, column.numbers.size(), column.name, name, tasks, episodes);
    // Tasks of this category's length, fewer or more.
    for (std::size_t other = 1; other <= kMostTasks; ++other) {
      if (misfits(column, episodes / tasks * other) != 0) continue;
      finding.message += fmt::format("; all are over {} such tasks", other);
      break;
    }
    finding.place = place_of_set(compilation, column.name);
    audit.findings.push_back(std::move(finding));
  }
  if (!any) return Failure{Fault::kTable, "no column is called as a set of the suite", name};
  std::stable_sort(audit.findings.begin(), audit.findings.end(),
                   [](const Finding& a, const Finding& b) { return a.kind < b.kind; });
  return {};
}

}  // namespace probe::audit
