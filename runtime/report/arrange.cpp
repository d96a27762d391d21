#include "runtime/report/arrange.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "runtime/base/printable.h"
#include "runtime/report/categories.h"

namespace probe::report {
namespace {

void note(Benchmark& benchmark, std::string level, std::string text) {
  benchmark.notes.push_back({std::move(level), std::move(text)});
}

void label_policies(Benchmark& benchmark) {
  for (Policy& policy : benchmark.policies) {
    const auto same = std::count_if(benchmark.policies.begin(), benchmark.policies.end(),
                                    [&](const Policy& other) { return other.name == policy.name; });
    if (same < 2 || policy.runs.empty()) continue;
    policy.label = fmt::format("{} ({})", policy.name, printable(policy.runs[0].dir, kLongestText));
    const auto first = std::find_if(benchmark.policies.begin(), benchmark.policies.end(),
                                    [&](const Policy& other) { return other.name == policy.name; });
    if (&*first == &policy) {
      note(benchmark, "note",
           fmt::format("policy `{}` was run more than once; its runs stand apart, each "
                       "with its folder",
                       policy.name));
    }
  }
}

void label_models(Benchmark& benchmark) {
  for (AskedModel& model : benchmark.models) {
    const auto same = std::ranges::count(benchmark.models, model.name, &AskedModel::name);
    model.label = same < 2 ? model.name
                           : fmt::format("{} ({})", model.name, printable(model.dir, kLongestText));
  }
}

// Tables have no notes: what nobody vouches for is told by its name there.
void mark_unchecked(Benchmark& benchmark) {
  for (AskedModel& model : benchmark.models) {
    if (model.is_unchecked) model.label += " (--insecure)";
  }
  for (Policy& policy : benchmark.policies) {
    if (std::ranges::any_of(policy.runs,
                            [](const RunInfo& run) { return run.reading.is_unchecked; }))
      policy.label += " (--insecure)";
  }
}

void note_two_meanings(Benchmark& benchmark, const std::vector<std::string>& names_of_two) {
  if (names_of_two.empty()) return;
  std::string names;
  for (std::size_t i = 0; i < names_of_two.size() && i < kNamed; ++i)
    names += (i == 0 ? "`" : ", `") + names_of_two[i] + "`";
  if (names_of_two.size() > kNamed)
    names += fmt::format(" and {} more", names_of_two.size() - kNamed);
  note(benchmark, "warn",
       fmt::format("{} tasks mean different things in different plans (another instruction, rule "
                   "or object) and are shown apart: {}",
                   names_of_two.size(), names));
}

void note_runs(Benchmark& benchmark) {
  for (const Policy& policy : benchmark.policies) {
    int done = 0, invalid = 0, expected = 0;
    store::NotAttempted not_attempted;
    for (const RunInfo& run : policy.runs) {
      done += run.done;
      invalid += run.invalid;
      not_attempted.add(run.not_attempted);
      expected = std::max(expected, run.expected);
    }
    if (done < expected) {
      note(benchmark, "warn",
           fmt::format("`{}` is partial: {} of {} episodes of the suite; only starts "
                       "that both sides have are compared",
                       policy.label, done, expected));
    }
    if (not_attempted.count() > 0) {
      note(benchmark, "note",
           fmt::format("`{}`: {} of {} episodes were not attempted: {}", policy.label,
                       not_attempted.count(), done, store::to_text(not_attempted)));
    }
    if (invalid > 0) {
      note(benchmark, invalid == done ? "bad" : "warn",
           fmt::format("`{}`: {} of {} episodes are invalid and count neither way", policy.label,
                       invalid, done));
    }
  }
  std::set<std::string> roots;
  for (const PlanInfo& plan : benchmark.plans) roots.insert(plan.root);
  if (roots.size() > 1) {
    note(benchmark, "warn",
         fmt::format("the runs are of {} plans; tasks are joined where instruction, rule "
                     "and objects agree, and compared on common starts only",
                     roots.size()));
  }
  for (const std::string& line : benchmark.fingerprint_differences)
    note(benchmark, "note", "the runs' builds or machines differ: " + line);
}

// Truths first, so that they are bits; numbers stay in the rows.
void order_metrics(Benchmark& benchmark) {
  std::vector<int> order(benchmark.metrics.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<int>(i);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
    return benchmark.metrics[static_cast<std::size_t>(a)].truth >
           benchmark.metrics[static_cast<std::size_t>(b)].truth;
  });
  std::vector<int> now(order.size());
  std::vector<Metric> metrics;
  for (std::size_t i = 0; i < order.size(); ++i) {
    now[static_cast<std::size_t>(order[i])] = static_cast<int>(i);
    metrics.push_back(benchmark.metrics[static_cast<std::size_t>(order[i])]);
  }
  benchmark.metrics = std::move(metrics);
  for (Task& task : benchmark.tasks) {
    for (int& m : task.metrics) m = now[static_cast<std::size_t>(m)];
  }
  const auto truths = static_cast<std::size_t>(
      std::count_if(benchmark.metrics.begin(), benchmark.metrics.end(),
                    [](const Metric& metric) { return metric.truth; }));
  const bool is_same = std::is_sorted(now.begin(), now.end());
  for (Episode& e : benchmark.episodes) {
    if (!is_same) {
      Truths ordered;
      for (std::size_t i = 0; i < now.size(); ++i) {
        if (e.truths[i]) ordered.set(static_cast<std::size_t>(now[i]));
      }
      e.truths = std::move(ordered);
    }
    if (e.numbers.empty()) continue;
    std::vector<double> numbers(now.size() - truths, std::nan(""));
    for (std::size_t i = 0; i < e.numbers.size(); ++i) {
      if (const auto at = static_cast<std::size_t>(now[i]); at >= truths)
        numbers[at - truths] = e.numbers[i];
    }
    e.numbers = std::move(numbers);
  }
}

// Tasks that no run's suite lists and no episode is of; baselines of the others stay.
void drop_unused_tasks(Benchmark& benchmark, const JoinedPlans& plans) {
  std::vector<bool> used(benchmark.tasks.size(), false);
  for (const Episode& e : benchmark.episodes) used[static_cast<std::size_t>(e.task)] = true;
  for (const Policy& policy : benchmark.policies) {
    if (!policy.adaptive) continue;
    for (const AdaptivePolicy::Place& place : policy.adaptive->order)
      if (place.task != kAbsent) used[static_cast<std::size_t>(place.task)] = true;
  }
  for (const AskedModel& model : benchmark.models) {
    for (const AskedModel::Known& known : model.known)
      used[static_cast<std::size_t>(known.task)] = true;
  }
  for (std::size_t p = 0; p < benchmark.plans.size(); ++p) {
    for (const std::uint32_t t : plans.members(p))
      used[static_cast<std::size_t>(plans.map(static_cast<int>(p)).task[t])] = true;
  }
  for (std::size_t t = benchmark.tasks.size(); t-- > 0;) {
    for (int b = static_cast<int>(t); used[t] && b != kAbsent;
         b = benchmark.tasks[static_cast<std::size_t>(b)].baseline)
      used[static_cast<std::size_t>(b)] = true;
  }
  std::vector<int> now(used.size(), kAbsent);
  std::vector<Task> tasks;
  for (std::size_t t = 0; t < used.size(); ++t) {
    if (!used[t]) continue;
    now[t] = static_cast<int>(tasks.size());
    tasks.push_back(std::move(benchmark.tasks[t]));
  }
  for (Task& task : tasks) {
    if (task.baseline != kAbsent) task.baseline = now[static_cast<std::size_t>(task.baseline)];
  }
  for (Episode& e : benchmark.episodes) e.task = now[static_cast<std::size_t>(e.task)];
  for (Policy& policy : benchmark.policies) {
    if (!policy.adaptive) continue;
    for (AdaptivePolicy::Place& place : policy.adaptive->order)
      if (place.task != kAbsent) place.task = now[static_cast<std::size_t>(place.task)];
  }
  for (AskedModel& model : benchmark.models) {
    for (AskedModel::Known& known : model.known)
      known.task = now[static_cast<std::size_t>(known.task)];
  }
  benchmark.tasks = std::move(tasks);
}

void mark_pairing(const Benchmark& benchmark, Task& task) {
  if (task.baseline == kAbsent) return;
  const Task& baseline = benchmark.tasks[static_cast<std::size_t>(task.baseline)];
  if (baseline.scene != task.scene) {
    task.unpaired =
        fmt::format("it is in scene {}, the baseline in {}", task.scene, baseline.scene);
    return;
  }
  if (baseline.starts.size() != task.starts.size()) {
    task.unpaired = fmt::format("it has {} starts, the baseline {}", task.starts.size(),
                                baseline.starts.size());
    return;
  }
  for (std::size_t s = 0; s < task.starts.size(); ++s) {
    const StartPlace &here = task.starts[s], &there = baseline.starts[s];
    if (here.cluster == there.cluster || here.taken == there.taken) continue;
    task.unpaired = "its objects start in other places than the baseline's";
    return;
  }
}

}  // namespace

void arrange(Benchmark& benchmark, const JoinedPlans& plans, const std::vector<std::string>& sets) {
  label_policies(benchmark);
  label_models(benchmark);
  mark_unchecked(benchmark);
  order_metrics(benchmark);
  drop_unused_tasks(benchmark, plans);
  for (Task& task : benchmark.tasks) mark_pairing(benchmark, task);
  index_episodes(benchmark);
  find_categories(benchmark, sets);
  note_two_meanings(benchmark, plans.two_meanings());
  note_runs(benchmark);
}

}  // namespace probe::report
