#include "runtime/rejudge/changes.h"

#include <algorithm>

namespace probe::rejudge {
namespace {

const store::MetricValue* find_metric(const store::ResultRow& row, const std::string& name) {
  const auto it = std::ranges::find(row.metrics, name, &store::MetricValue::name);
  return it == row.metrics.end() ? nullptr : &*it;
}

}  // namespace

void count_changes(std::vector<MetricChange>& changes, const store::ResultRow& before,
                   const store::ResultRow& after) {
  const auto change_of = [&](const store::MetricValue& metric) -> MetricChange& {
    const auto it = std::ranges::find(changes, metric.name, &MetricChange::name);
    if (it != changes.end()) return *it;
    changes.push_back({.name = metric.name, .is_bool = metric.is_bool});
    return changes.back();
  };
  for (const store::MetricValue& old : before.metrics) {
    MetricChange& change = change_of(old);
    const store::MetricValue* now = find_metric(after, old.name);
    if (now == nullptr || now->is_bool != old.is_bool) {
      ++change.only_before;
      continue;
    }
    ++change.episodes;
    change.before += old.value != 0;
    change.after += now->value != 0;
    change.lost += old.value != 0 && now->value == 0;
    change.gained += old.value == 0 && now->value != 0;
    change.changed += old.value != now->value;
    // Running means, so that a million episodes do not lose digits.
    change.mean_before += (old.value - change.mean_before) / change.episodes;
    change.mean_after += (now->value - change.mean_after) / change.episodes;
  }
  for (const store::MetricValue& now : after.metrics) {
    if (find_metric(before, now.name) == nullptr) ++change_of(now).only_after;
  }
}

}  // namespace probe::rejudge
