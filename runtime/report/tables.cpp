#include "runtime/report/tables.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include "runtime/base/numbering.h"
#include "runtime/base/percent.h"
#include "runtime/inspect/axes.h"

namespace probe::report {
namespace {

using stats::Count;
using stats::PairTable;
using stats::StartArms;
using stats::StartCount;

const Task& task_at(const Benchmark& benchmark, int task) {
  return benchmark.tasks[static_cast<std::size_t>(task)];
}

std::uint32_t cluster_at(const Benchmark& benchmark, int task, int start) {
  return task_at(benchmark, task).starts[static_cast<std::size_t>(start)].cluster;
}

bool has(const Benchmark& benchmark, int task, int metric) {
  const auto& metrics = task_at(benchmark, task).metrics;
  return std::find(metrics.begin(), metrics.end(), metric) != metrics.end();
}

// Says of each episode whether it is a new observation.
class Fresh {
 public:
  bool operator()(const Episode& e) { return e.shared < 0 || seen_.insert(e.shared).second; }

 private:
  std::set<std::int64_t> seen_;
};

// Valid episodes of the tasks, a row a start.
std::vector<StartCount> counts_of(const Benchmark& benchmark, int policy, int metric,
                                  const std::vector<int>& tasks) {
  std::vector<StartCount> rows;
  Numbering<int> task_ids;
  Numbering<std::uint32_t> clusters;
  Fresh is_fresh;
  for (const int task : tasks) {
    if (!has(benchmark, task, metric)) continue;
    int start = kAbsent;
    for (const Episode& e : benchmark.of(policy, task)) {
      if (!e.valid() || !is_fresh(e)) continue;
      if (e.start != start) {
        start = e.start;
        rows.push_back({{0, 0}, task_ids(task), clusters(cluster_at(benchmark, task, start))});
      }
      rows.back().count.k += e.is(metric) ? 1 : 0;
      ++rows.back().count.n;
    }
  }
  return rows;
}

Count total(const std::vector<StartCount>& rows) {
  Count all;
  for (const StartCount& row : rows) {
    all.k += row.count.k;
    all.n += row.count.n;
  }
  return all;
}

// Calls visit(start, a, b) for every pair of valid episodes of two ascending lists with the same
// start and seed.
template <typename Visit>
void for_each_pair(std::span<const Episode> a, std::span<const Episode> b, Visit&& visit) {
  std::size_t i = 0, j = 0;
  while (i < a.size() && j < b.size()) {
    const auto left = std::pair(a[i].start, a[i].seed);
    const auto right = std::pair(b[j].start, b[j].seed);
    if (left < right) {
      ++i;
    } else if (right < left) {
      ++j;
    } else {
      if (a[i].valid() && b[j].valid()) visit(a[i].start, a[i], b[j]);
      ++i;
      ++j;
    }
  }
}

Contrast unpaired(const std::vector<StartCount>& a, const std::vector<StartCount>& b) {
  Contrast contrast;
  contrast.paired = false;
  contrast.first = total(a);
  contrast.second = total(b);
  contrast.starts = static_cast<std::int64_t>(std::min(a.size(), b.size()));
  const stats::Difference d = stats::unpaired_difference(a, b);
  contrast.difference = d.estimate;
  std::vector<Count> first, second;
  for (const StartCount& row : a) first.push_back(row.count);
  for (const StartCount& row : b) second.push_back(row.count);
  // Starts that do not correspond cannot be exchanged one for one: dealing them out anew answers
  // both questions.
  contrast.here.interval = d.interval;
  contrast.here.p = stats::unpaired_exact(first, second);
  contrast.anew = contrast.here;
  return contrast;
}

bool is_empty(const Contrast& contrast) { return contrast.first.n == 0 || contrast.second.n == 0; }

// Tasks without distractors whose words say what is meant: what objects alone are worth.
bool is_plain(const Benchmark& benchmark, int task) {
  if (!task_at(benchmark, task).distractors.empty()) return false;
  const std::uint32_t worded = plan::kLanguageAxes & ~plan::bit(plan::Axis::kLanguageParaphrase);
  for (int t = task; t != kAbsent; t = task_at(benchmark, t).baseline) {
    if ((task_at(benchmark, t).axes & worded) != 0) return false;
  }
  return true;
}

// Adjusts the rows for which `family` is equal.
template <typename Rows, typename Family>
void adjust_rows(Rows& rows, Adjustment method, Family family) {
  std::map<std::pair<int, int>, std::vector<Contrast*>> families;
  for (auto& row : rows) families[family(row)].push_back(&row.contrast);
  for (const auto& [key, members] : families) adjust(members, method);
}

// Of a policy that stops by what it finds; nothing where no interval can be vouched for.
std::optional<Estimate> adaptive_estimate(const Benchmark& benchmark, int policy, int metric,
                                          const std::vector<int>& tasks) {
  const AdaptivePolicy& of = *benchmark.policies[static_cast<std::size_t>(policy)].adaptive;
  const adaptive::Sampled lists(of.rule.kind, of.seeds);
  std::vector<adaptive::SampledTask> all;
  Estimate out;
  for (const int task : tasks) {
    if (!has(benchmark, task, metric)) continue;
    std::map<std::pair<int, int>, std::vector<const Episode*>> episodes;  // by start and seed
    for (const Episode& e : benchmark.of(policy, task)) episodes[{e.start, e.seed}].push_back(&e);
    adaptive::SampledTask sampled;
    for (const std::size_t index : of.places_of(task)) {
      const AdaptivePolicy::Place& place = of.order[index];
      auto& there = episodes[{place.start, place.seed}];
      adaptive::Outcome outcome = adaptive::Outcome::kAbsent;
      if (!there.empty()) {
        outcome = outcome_of(*there.back(), metric);
        out.count.k += outcome == adaptive::Outcome::kSuccess ? 1 : 0;
        out.count.n += there.back()->valid() ? 1 : 0;
        there.pop_back();
      }
      lists.add(sampled, place.seed, outcome);
    }
    if (!sampled.lists.empty()) all.push_back(std::move(sampled));
  }
  const auto rate = adaptive::rate_of(of.rule, of.drawing, all);
  if (!rate || out.count.n == 0) return std::nullopt;
  out.interval = rate->interval;
  if (std::abs(rate->rate - out.count.rate()) > 1e-9) out.weighted = rate->rate;
  return out;
}

class Maker {
 public:
  explicit Maker(const Benchmark& benchmark)
      : benchmark_(benchmark), metrics_(table_metrics(benchmark)) {}

  Tables make() {
    by_task();
    for (int p = 0; p < policies(); ++p) {
      for (const int m : metrics_) {
        main_row(p, m);
        if (!benchmark_.is_adaptive(p)) deltas(p, m);
        objects(p, m);
      }
      if (!benchmark_.is_adaptive(p)) gap(p);
    }
    floors();
    compare_policies();
    const auto of = [](const auto& row) { return std::pair(row.policy, row.metric); };
    adjust_rows(tables_.deltas, Adjustment::kBenjaminiHochberg, of);
    adjust_rows(tables_.category_deltas, Adjustment::kHolm, of);
    adjust_rows(tables_.policies, Adjustment::kHolm, [](const PolicyRow& row) {
      return std::pair(row.metric, row.category == kAbsent ? 1 : 0);
    });
    if (policies() <= kFewPolicies) {
      for (PolicyRow& row : tables_.policies) say_what_would_tell(row.contrast);
    }
    return std::move(tables_);
  }

 private:
  int policies() const { return static_cast<int>(benchmark_.policies.size()); }
  int task_count() const { return static_cast<int>(benchmark_.tasks.size()); }

  void by_task() {
    tables_.by_task.resize(benchmark_.metrics.size());
    for (std::size_t m = 0; m < benchmark_.metrics.size(); ++m) {
      if (!benchmark_.metrics[m].truth) continue;
      tables_.by_task[m].resize(benchmark_.policies.size());
      for (int p = 0; p < policies(); ++p) {
        for (int t = 0; t < task_count(); ++t) {
          tables_.by_task[m][static_cast<std::size_t>(p)].push_back(
              estimate(benchmark_, p, static_cast<int>(m), {t}));
        }
      }
    }
  }

  void main_row(int policy, int metric) {
    MainRow row{policy, metric, estimate(benchmark_, policy, metric, benchmark_.all_tasks()), {}};
    for (const Category& category : benchmark_.categories)
      row.cells.push_back(estimate(benchmark_, policy, metric, category.tasks));
    tables_.main.push_back(std::move(row));
  }

  void deltas(int policy, int metric) {
    for (int t = 0; t < task_count(); ++t) {
      if (task_at(benchmark_, t).baseline == kAbsent) continue;
      DeltaRow row{policy, t, metric, variant_contrast(benchmark_, policy, metric, t), false};
      if (is_empty(row.contrast)) continue;
      row.at_floor = row.contrast.second.k == 0 &&
                     benchmark_.metrics[static_cast<std::size_t>(metric)].good > 0;
      tables_.deltas.push_back(std::move(row));
    }
    for (std::size_t c = 0; c < benchmark_.categories.size(); ++c) {
      CategoryDeltaRow row{policy, static_cast<int>(c), metric, {}, 0};
      row.contrast = category_contrast(benchmark_, policy, metric, benchmark_.categories[c].tasks,
                                       row.left_out);
      if (!is_empty(row.contrast)) tables_.category_deltas.push_back(std::move(row));
    }
  }

  void objects(int policy, int metric) {
    std::map<std::pair<int, int>, std::vector<int>> pairs;
    std::map<std::pair<bool, int>, std::vector<int>> single;
    for (int t = 0; t < task_count(); ++t) {
      if (!is_plain(benchmark_, t)) continue;
      const Task& task = task_at(benchmark_, t);
      if (task.source != kAbsent && task.target != kAbsent)
        pairs[{task.source, task.target}].push_back(t);
      if (task.source != kAbsent) single[{false, task.source}].push_back(t);
      if (task.target != kAbsent) single[{true, task.target}].push_back(t);
    }
    for (const auto& [objects, tasks] : pairs) {
      const auto e = estimate(benchmark_, policy, metric, tasks);
      if (!e) continue;
      tables_.pairs.push_back(
          {policy, objects.first, objects.second, metric, *e, task_at(benchmark_, tasks[0]).ood});
    }
    for (const auto& [key, tasks] : single) {
      const auto e = estimate(benchmark_, policy, metric, tasks);
      if (!e) continue;
      const bool as_source = !key.first;
      const Object& object = benchmark_.objects[static_cast<std::size_t>(key.second)];
      const auto& seen = as_source ? object.seen_as_source : object.seen_as_target;
      tables_.objects.push_back({policy, key.second, metric, as_source, seen == false, *e});
    }
  }

  void gap(int policy) {
    const int intention = benchmark_.find_metric("intention");
    const int success = benchmark_.find_metric("success");
    if (intention == kAbsent || success == kAbsent) return;
    const auto add = [&](int category, const std::vector<int>& tasks) {
      PairRows pairs;
      for (const int t : tasks) {
        if (!has(benchmark_, t, intention) || !has(benchmark_, t, success)) continue;
        int start = kAbsent;
        for (const Episode& e : benchmark_.of(policy, t)) {
          if (!e.valid()) continue;
          count_pair(pairs.at(t, cluster_at(benchmark_, t, e.start), t, e.start != start),
                     e.is(intention), e.is(success));
          start = e.start;
        }
      }
      if (pairs.empty()) return;
      tables_.gap.push_back({policy, category, pairs.contrast(),
                             estimate(benchmark_, policy, intention, tasks),
                             estimate(benchmark_, policy, success, tasks)});
    };
    add(kAbsent, benchmark_.all_tasks());
    for (std::size_t c = 0; c < benchmark_.categories.size(); ++c)
      add(static_cast<int>(c), benchmark_.categories[c].tasks);
  }

  std::optional<Estimate> of_role(Role role, int metric, int task) const {
    for (int p = 0; p < policies(); ++p) {
      if (benchmark_.policies[static_cast<std::size_t>(p)].role != role) continue;
      if (auto e = estimate(benchmark_, p, metric, {task})) return e;
    }
    return std::nullopt;
  }

  void floors() {
    for (int t = 0; t < task_count(); ++t) {
      for (const int m : metrics_) {
        FloorRow row{t, m, of_role(Role::kFloor, m, t), of_role(Role::kCeiling, m, t), ""};
        if (!row.floor && !row.ceiling) continue;
        const int good = benchmark_.metrics[static_cast<std::size_t>(m)].good;
        if (good > 0 && row.floor && row.floor->count.k > 0)
          row.note = "a policy that does nothing has it too";
        if (good > 0 && row.ceiling && row.ceiling->count.k < row.ceiling->count.n)
          row.note = "not even the expert always has it";
        tables_.floors.push_back(std::move(row));
      }
    }
  }

  // With more policies than these only sums over all tasks are compared: the table grows with their
  // square.
  static constexpr int kFewPolicies = 8;
  void compare_policies() {
    for (int a = 0; a < policies(); ++a) {
      for (int b = a + 1; b < policies(); ++b) {
        for (const int m : metrics_) {
          compare(a, b, m, kAbsent, benchmark_.all_tasks());
          if (policies() > kFewPolicies) continue;
          for (std::size_t c = 0; c < benchmark_.categories.size(); ++c)
            compare(a, b, m, static_cast<int>(c), benchmark_.categories[c].tasks);
        }
      }
    }
  }

  void compare(int a, int b, int metric, int category, const std::vector<int>& tasks) {
    if (benchmark_.is_adaptive(a) || benchmark_.is_adaptive(b)) return;
    PolicyRow row{a, b, metric, category, policy_contrast(benchmark_, a, b, metric, tasks)};
    if (is_empty(row.contrast)) return;
    tables_.policies.push_back(std::move(row));
  }

  const Benchmark& benchmark_;
  std::vector<int> metrics_;
  Tables tables_;
};

}  // namespace

adaptive::Outcome outcome_of(const Episode& episode, int metric) {
  if (episode.valid())
    return episode.is(metric) ? adaptive::Outcome::kSuccess : adaptive::Outcome::kFailure;
  return episode.is_open ? adaptive::Outcome::kUnknown : adaptive::Outcome::kNotAttempted;
}

std::vector<int> table_metrics(const Benchmark& benchmark) {
  std::vector<int> metrics;
  for (const char* name : {"intention", "grasp", "success", "wrong"}) {
    if (const int m = benchmark.find_metric(name); m != kAbsent) metrics.push_back(m);
  }
  if (!metrics.empty()) return metrics;
  for (std::size_t m = 0; m < benchmark.metrics.size(); ++m) {
    if (benchmark.metrics[m].truth) metrics.push_back(static_cast<int>(m));
  }
  return metrics;
}

std::optional<Estimate> estimate(const Benchmark& benchmark, int policy, int metric,
                                 const std::vector<int>& tasks) {
  if (benchmark.is_adaptive(policy)) return adaptive_estimate(benchmark, policy, metric, tasks);
  const auto rows = counts_of(benchmark, policy, metric, tasks);
  if (rows.empty()) return std::nullopt;
  return Estimate{total(rows), stats::clustered_rate(rows)};
}

Contrast variant_contrast(const Benchmark& benchmark, int policy, int metric, int task) {
  const Task& variant = task_at(benchmark, task);
  if (!variant.unpaired.empty()) {
    return unpaired(counts_of(benchmark, policy, metric, {task}),
                    counts_of(benchmark, policy, metric, {variant.baseline}));
  }
  PairRows pairs;
  if (has(benchmark, task, metric) && has(benchmark, variant.baseline, metric)) {
    int last = kAbsent;
    for_each_pair(benchmark.of(policy, task), benchmark.of(policy, variant.baseline),
                  [&](int start, const Episode& a, const Episode& b) {
                    count_pair(
                        pairs.at(task, cluster_at(benchmark, task, start), task, start != last),
                        a.is(metric), b.is(metric));
                    last = start;
                  });
  }
  return pairs.contrast();
}

Contrast category_contrast(const Benchmark& benchmark, int policy, int metric,
                           const std::vector<int>& tasks, int& left_out) {
  PairRows pairs;
  std::map<std::pair<int, int>, StartArms> arms;  // by baseline and start
  left_out = 0;
  for (const int task : tasks) {
    const Task& variant = task_at(benchmark, task);
    if (variant.baseline == kAbsent) continue;
    if (!variant.unpaired.empty()) {
      ++left_out;
      continue;
    }
    if (!has(benchmark, task, metric) || !has(benchmark, variant.baseline, metric)) continue;
    std::map<int, std::pair<Count, Count>> by_start;
    int last = kAbsent;
    for_each_pair(benchmark.of(policy, task), benchmark.of(policy, variant.baseline),
                  [&](int start, const Episode& a, const Episode& b) {
                    count_pair(pairs.at(task, cluster_at(benchmark, task, start), variant.baseline,
                                        start != last),
                               a.is(metric), b.is(metric));
                    last = start;
                    auto& [ours, theirs] = by_start[start];
                    ours.k += a.is(metric) ? 1 : 0;
                    theirs.k += b.is(metric) ? 1 : 0;
                    ++ours.n;
                    ++theirs.n;
                  });
    for (const auto& [start, counts] : by_start) {
      StartArms& of_start = arms[{variant.baseline, start}];
      // Where a variant lacks seeds, the baseline is counted on those that the first one has.
      if (of_start.empty()) of_start.push_back(counts.second);
      of_start.push_back(counts.first);
    }
  }
  Contrast contrast = pairs.contrast();
  std::vector<StartArms> starts;
  for (auto& [key, of_start] : arms) starts.push_back(std::move(of_start));
  contrast.starts = static_cast<std::int64_t>(starts.size());
  contrast.here.p = stats::shared_baseline_exact(starts);
  return contrast;
}

PairRows policy_pairs(const Benchmark& benchmark, int a, int b, int metric,
                      const std::vector<int>& tasks) {
  PairRows pairs;
  Fresh is_fresh;
  for (const int task : tasks) {
    if (!has(benchmark, task, metric)) continue;
    int last = kAbsent;
    for_each_pair(benchmark.of(a, task), benchmark.of(b, task),
                  [&](int start, const Episode& of_a, const Episode& of_b) {
                    if (!is_fresh(of_a)) return;
                    count_pair(
                        pairs.at(task, cluster_at(benchmark, task, start), task, start != last),
                        of_a.is(metric), of_b.is(metric));
                    last = start;
                  });
  }
  return pairs;
}

Contrast policy_contrast(const Benchmark& benchmark, int a, int b, int metric,
                         const std::vector<int>& tasks) {
  return policy_pairs(benchmark, a, b, metric, tasks).contrast();
}

std::string rate_text(const Estimate& estimate) {
  return estimate.weighted ? decimal_text(100 * *estimate.weighted, 1)
                           : percent_text(estimate.count.k, estimate.count.n);
}

Tables make_tables(const Benchmark& benchmark) { return Maker(benchmark).make(); }

}  // namespace probe::report
