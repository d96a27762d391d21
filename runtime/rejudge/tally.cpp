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

// "mean 91.2cm, 88cm .. 1.02m", and how often it never came.
std::string numbers_text(std::vector<double> values, const MetricKind& kind) {
  const auto never = kind.never ? std::erase(values, *kind.never) : 0;
  std::string text;
  if (!values.empty()) {
    double sum = 0;
    for (const double value : values) sum += value;
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    text = fmt::format("mean {}, {} .. {}",
                       quantity(sum / static_cast<double>(values.size()), kind.dimension),
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

std::string TallyText::text(const plan::Plan* plan) const {
  std::string text;
  const auto out = std::back_inserter(text);
  for (const std::string& task : parts_->order) {
    const Parts::Tally& tally = parts_->tallies.at(task);
    fmt::format_to(out, "{}: {} episodes", task,
                   tally.valid + tally.invalid + tally.not_attempted.count());
    if (tally.not_attempted.count() > 0)
      fmt::format_to(out, ", {} not attempted ({})", tally.not_attempted.count(),
                     store::to_text(tally.not_attempted));
    if (tally.invalid > 0)
      fmt::format_to(out, ", {} invalid ({})", tally.invalid, tally.first_invalid);
    text += '\n';
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
