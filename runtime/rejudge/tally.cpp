#include "runtime/rejudge/tally.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <vector>

#include "runtime/base/printable.h"
#include "runtime/plan/readouts.h"
#include "runtime/rejudge/dimension.h"
#include "runtime/store/not_attempted.h"
#include "runtime/store/run_plan.h"
#include "runtime/store/store.h"

namespace probe::rejudge {
struct TallyText::Parts {
  struct Column {
    std::string name;
    bool is_bool = true;
    int trues = 0;
    std::vector<double> values;
  };

  // What a policy says of some episodes.
  struct Remark {
    std::string text;
    int count = 0;
  };

  struct Tally {
    int valid = 0, invalid = 0;
    store::NotAttempted not_attempted;
    std::string first_invalid;  // which, and why
    std::vector<Remark> remarks;
    std::vector<Column> columns;
  };

  std::vector<std::string> order;  // of tasks
  std::map<std::string, Tally> tallies;
  static void add(Tally& tally, const store::ResultRow& row);
};

namespace {

constexpr std::size_t kMostRemarks = 3, kLongestRemark = 300;  // of a task; characters

// What the plan says of one metric; without it a number is a number.
struct MetricKind {
  Dimension dimension = Dimension::kNumber;
  std::optional<double> never = {};  // the value that says so
};

MetricKind kind_of(const plan::Plan* plan, const std::string& task, const std::string& metric) {
  const auto index = plan == nullptr ? std::nullopt : plan->find_task(task);
  if (!index) return {};
  const plan::TaskRecord& record = plan->tasks()[*index];
  const auto at = plan->find_metric(record, metric);
  if (!at) return {};
  return {metric_dimensions(*plan, plan->programs()[record.program])[*at],
          plan::find_readout(plan->metrics(record)[*at].readout)->never};
}

double mean_of(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

// "mean 91.2cm, 88cm .. 1.02m", and how often it never came.
std::string numbers_text(std::vector<double> values, const MetricKind& kind) {
  const auto never = kind.never ? std::erase(values, *kind.never) : 0;
  std::string text;
  if (!values.empty()) {
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    text = fmt::format("mean {}, {} .. {}", quantity(mean_of(values), kind.dimension),
                       quantity(*low, kind.dimension), quantity(*high, kind.dimension));
  }
  if (never > 0) text += fmt::format("{}never in {}", text.empty() ? "" : "; ", never);
  return text;
}

}  // namespace

std::optional<plan::Plan> stored_plan(const std::string& dir) {
  auto plan = store::open_run_plan(dir);
  if (!plan) return std::nullopt;
  return std::move(plan).value();
}

void TallyText::Parts::add(Tally& tally, const store::ResultRow& row) {
  if (store::is_not_attempted(row)) {
    tally.not_attempted.add(row);
    return;
  }
  if (row.invalid) {
    if (tally.invalid++ == 0) {
      tally.first_invalid =
          fmt::format("episode {} seed {}: {}", row.episode, row.seed, *row.invalid);
    }
    return;
  }
  ++tally.valid;
  if (row.remark) {
    auto said = std::ranges::find(tally.remarks, *row.remark, &Remark::text);
    if (said == tally.remarks.end()) said = tally.remarks.insert(said, Remark{*row.remark, 0});
    ++said->count;
  }
  for (const store::MetricValue& metric : row.metrics) {
    auto column = std::find_if(tally.columns.begin(), tally.columns.end(),
                               [&](const Column& known) { return known.name == metric.name; });
    if (column == tally.columns.end()) {
      tally.columns.push_back({metric.name, metric.is_bool, 0, {}});
      column = tally.columns.end() - 1;
    }
    column->trues += metric.is_bool && metric.value != 0 ? 1 : 0;
    if (!metric.is_bool) column->values.push_back(metric.value);
  }
}

TallyText::TallyText() : parts_(std::make_unique<Parts>()) {}
TallyText::~TallyText() = default;

void TallyText::add(const store::ResultRow& row) {
  const auto [it, fresh] = parts_->tallies.try_emplace(row.task);
  if (fresh) parts_->order.push_back(row.task);
  Parts::add(it->second, row);
}

std::string tally_text(std::span<const store::ResultRow> rows, const plan::Plan* plan) {
  TallyText tally;
  for (const store::ResultRow& row : rows) tally.add(row);
  return tally.text(plan);
}

namespace {

// "3 not attempted (..)", "1 invalid (..)"; empty where all were judged.
std::string unjudged_text(const store::NotAttempted& not_attempted, int invalid,
                          const std::string& first_invalid) {
  std::string text;
  if (not_attempted.count() > 0)
    text += fmt::format(", {} not attempted ({})", not_attempted.count(),
                        store::to_text(not_attempted));
  if (invalid > 0) text += fmt::format(", {} invalid ({})", invalid, first_invalid);
  return text;
}

// The mean alone; of a `first` that did not always come, of those in which it did: "1.2s in 3/24".
std::string mean_text(std::vector<double> values, const MetricKind& kind) {
  const std::size_t all = values.size();
  if (kind.never) std::erase(values, *kind.never);
  if (values.empty()) return "never";
  const std::string mean = quantity(mean_of(values), kind.dimension);
  return values.size() == all ? mean : fmt::format("{} in {}/{}", mean, values.size(), all);
}

}  // namespace

std::string TallyText::table(const plan::Plan* plan) const {
  std::vector<std::string> names;  // of metrics, as they come
  std::vector<std::vector<std::string>> rows = {{"task", "episodes"}};
  std::vector<Parts::Remark> remarks;
  int valid = 0;
  for (const std::string& task : parts_->order) {
    for (const Parts::Column& column : parts_->tallies.at(task).columns) {
      if (std::ranges::find(names, column.name) == names.end()) names.push_back(column.name);
    }
  }
  rows[0].insert(rows[0].end(), names.begin(), names.end());
  bool has_numbers = false;
  for (const std::string& task : parts_->order) {
    const Parts::Tally& tally = parts_->tallies.at(task);
    valid += tally.valid;
    std::vector<std::string>& row = rows.emplace_back();
    row = {task, std::to_string(tally.valid + tally.invalid + tally.not_attempted.count())};
    for (const std::string& name : names) {
      const auto column = std::ranges::find(tally.columns, name, &Parts::Column::name);
      if (column == tally.columns.end()) {
        row.push_back("-");
      } else if (column->is_bool) {
        row.push_back(fmt::format("{}/{}", column->trues, tally.valid));
      } else {
        has_numbers = true;
        row.push_back(mean_text(column->values, kind_of(plan, task, name)));
      }
    }
    for (const Parts::Remark& said : tally.remarks) {
      auto known = std::ranges::find(remarks, said.text, &Parts::Remark::text);
      if (known == remarks.end()) known = remarks.insert(known, Parts::Remark{said.text, 0});
      known->count += said.count;
    }
  }
  std::vector<std::size_t> widths(rows[0].size());
  for (const auto& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  }
  std::string text;
  const auto out = std::back_inserter(text);
  for (const auto& row : rows) {
    fmt::format_to(out, "{:<{}}", row[0], widths[0]);
    for (std::size_t i = 1; i < row.size(); ++i) fmt::format_to(out, "  {:>{}}", row[i], widths[i]);
    text += '\n';
  }
  for (const std::string& task : parts_->order) {
    const Parts::Tally& tally = parts_->tallies.at(task);
    const std::string unjudged =
        unjudged_text(tally.not_attempted, tally.invalid, tally.first_invalid);
    if (!unjudged.empty()) fmt::format_to(out, "{}: {}\n", task, unjudged.substr(2));
  }
  std::ranges::stable_sort(remarks, std::ranges::greater(), &Parts::Remark::count);
  for (std::size_t i = 0; i < remarks.size() && i < kMostRemarks; ++i)
    fmt::format_to(out, "{} of {}: {}\n", remarks[i].count, valid,
                   printable(remarks[i].text, kLongestRemark));
  if (remarks.size() > kMostRemarks || has_numbers)
    fmt::format_to(out, "{}`results DIR --long` has each task's remarks{}\n",
                   has_numbers ? "numbers are means; " : "",
                   has_numbers ? " and the least and most of each number" : "");
  return text;
}

std::string TallyText::text(const plan::Plan* plan, bool is_long) const {
  if (!is_long && parts_->order.size() > kMostInLines) return table(plan);
  std::string text;
  const auto out = std::back_inserter(text);
  for (const std::string& task : parts_->order) {
    const Parts::Tally& tally = parts_->tallies.at(task);
    fmt::format_to(out, "{}: {} episodes{}\n", task,
                   tally.valid + tally.invalid + tally.not_attempted.count(),
                   unjudged_text(tally.not_attempted, tally.invalid, tally.first_invalid));
    for (const Parts::Column& column : tally.columns) {
      if (column.is_bool) {
        fmt::format_to(out, "  {:<12} {:>4} of {}\n", column.name, column.trues, tally.valid);
      } else {
        fmt::format_to(out, "  {:<12} {}\n", column.name,
                       numbers_text(column.values, kind_of(plan, task, column.name)));
      }
    }
    std::vector<Parts::Remark> remarks = tally.remarks;
    std::ranges::stable_sort(remarks, std::ranges::greater(), &Parts::Remark::count);
    for (std::size_t i = 0; i < remarks.size() && i < kMostRemarks; ++i)
      fmt::format_to(out, "  {} of {}: {}\n", remarks[i].count, tally.valid,
                     printable(remarks[i].text, kLongestRemark));
    if (remarks.size() > kMostRemarks)
      fmt::format_to(out, "  and {} other remarks (--json)\n", remarks.size() - kMostRemarks);
  }
  return text;
}

}  // namespace probe::rejudge
