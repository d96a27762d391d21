#include "runtime/report/benchmark.h"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

namespace probe::report {

std::string name_apart(const std::string& task, const std::string& root) {
  return fmt::format("{} (plan {})", task, root.substr(0, 8));
}

std::string_view to_text(Role role) {
  switch (role) {
    case Role::kModel:
      return "model";
    case Role::kCeiling:
      return "ceiling";
    case Role::kFloor:
      return "floor";
    case Role::kRandom:
      return "random";
    case Role::kProbe:
      return "probe";
  }
  return "";
}

int Benchmark::find_metric(std::string_view name) const {
  for (std::size_t i = 0; i < metrics.size(); ++i) {
    if (metrics[i].name == name && metrics[i].truth) return static_cast<int>(i);
  }
  return kAbsent;
}

int Benchmark::find_task(std::string_view name) const {
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    if (tasks[i].name == name) return static_cast<int>(i);
  }
  return kAbsent;
}

std::span<const Episode> Benchmark::of(int policy, int task) const {
  const std::size_t cell =
      static_cast<std::size_t>(policy) * tasks.size() + static_cast<std::size_t>(task);
  return std::span(episodes).subspan(first[cell], first[cell + 1] - first[cell]);
}

std::vector<int> Benchmark::all_tasks() const {
  std::vector<int> all(tasks.size());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<int>(i);
  return all;
}

void index_episodes(Benchmark& benchmark) {
  const auto key = [](const Episode& e) { return std::tuple(e.policy, e.task, e.start, e.seed); };
  const auto before = [&](const Episode& a, const Episode& b) { return key(a) < key(b); };
  if (!std::is_sorted(benchmark.episodes.begin(), benchmark.episodes.end(), before))
    std::stable_sort(benchmark.episodes.begin(), benchmark.episodes.end(), before);
  const std::size_t cells = benchmark.policies.size() * benchmark.tasks.size();
  benchmark.first.assign(cells + 1, 0);
  for (const Episode& e : benchmark.episodes) {
    ++benchmark.first[static_cast<std::size_t>(e.policy) * benchmark.tasks.size() +
                      static_cast<std::size_t>(e.task) + 1];
  }
  for (std::size_t i = 0; i < cells; ++i) benchmark.first[i + 1] += benchmark.first[i];
  for (Policy& policy : benchmark.policies) {
    if (!policy.adaptive) continue;
    policy.adaptive->by_task.assign(benchmark.tasks.size(), {});
    for (std::size_t i = 0; i < policy.adaptive->order.size(); ++i) {
      const int task = policy.adaptive->order[i].task;
      if (task != kAbsent) policy.adaptive->by_task[static_cast<std::size_t>(task)].push_back(i);
    }
  }
}

}  // namespace probe::report
