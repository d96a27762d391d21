#include "runtime/report/event_tables.h"

#include <algorithm>
#include <map>

#include "runtime/report/page_data.h"
#include "runtime/report/tables.h"

namespace probe::report {
namespace {

int index_of(const std::vector<Metric>& metrics, const std::string& name) {
  const auto at = std::ranges::find(metrics, name, &Metric::name);
  return at == metrics.end() ? kAbsent : static_cast<int>(at - metrics.begin());
}

// Sets a truth of the episode and notes that its task has the metric.
void set(Benchmark& out, Episode& episode, const std::string& name, bool truth) {
  const int metric = index_of(out.metrics, name);
  if (metric == kAbsent) return;
  episode.truths.set(static_cast<std::size_t>(metric), truth);
  std::vector<int>& known = out.tasks[static_cast<std::size_t>(episode.task)].metrics;
  if (std::ranges::find(known, metric) == known.end()) known.push_back(metric);
}

// Mean, extremes and count of each number by policy and task: [mean, low, high, n], or null.
Json numbers_json(const Benchmark& benchmark, const ToldEvents& events) {
  struct Sum {
    double sum = 0, low = 0, high = 0;
    int n = 0;
  };
  std::map<std::string, std::map<std::pair<int, int>, Sum>> sums;
  const auto add = [&](const std::string& name, const Episode& e, const rejudge::Told& told) {
    if (!told.value) return;
    Sum& sum = sums[name][{e.policy, e.task}];
    sum.low = sum.n == 0 ? *told.value : std::min(sum.low, *told.value);
    sum.high = sum.n == 0 ? *told.value : std::max(sum.high, *told.value);
    sum.sum += *told.value;
    ++sum.n;
  };
  for (std::size_t i = 0; i < benchmark.episodes.size(); ++i) {
    const auto& told = events.told[i];
    const Episode& e = benchmark.episodes[i];
    if (!told || !told->untold.empty() || !e.valid()) continue;
    add("to_grasp", e, told->to_grasp);
    add("hand_over", e, told->hand_over);
    for (const rejudge::MotionInfo& motion : rejudge::all_motions()) {
      const auto at = static_cast<std::size_t>(motion.kind);
      if (at < told->motion.size()) add(std::string(motion.name), e, told->motion[at]);
    }
  }
  const auto listed = [&](const std::string& name, const std::string& unit) -> Json {
    Json rows = Json::array();
    for (const auto& [key, sum] : sums[name]) {
      rows.push_back({key.first, key.second, rounded(sum.sum / sum.n), rounded(sum.low),
                      rounded(sum.high), sum.n});
    }
    return {{"name", name},
            {"label", rejudge::event_words(name)},
            {"unit", unit},
            {"rows", std::move(rows)}};
  };
  Json out = Json::array();
  out.push_back(listed("to_grasp", "s"));
  out.push_back(listed("hand_over", "s"));
  for (const rejudge::MotionInfo& motion : rejudge::all_motions())
    out.push_back(listed(std::string(motion.name), std::string(motion.unit)));
  return out;
}

// What the page shows of them; make_tables() would compare policies in pairs, too.
Tables tables_of(const Benchmark& made) {
  Tables tables;
  const auto policies = static_cast<int>(made.policies.size());
  const auto tasks = static_cast<int>(made.tasks.size());
  tables.by_task.resize(made.metrics.size());
  for (std::size_t m = 0; m < made.metrics.size(); ++m) {
    const auto metric = static_cast<int>(m);
    for (int p = 0; p < policies; ++p) {
      tables.main.push_back({p, metric, estimate(made, p, metric, made.all_tasks()), {}});
      auto& row = tables.by_task[m].emplace_back();
      std::vector<Contrast*> family;
      const std::size_t first = tables.deltas.size();
      for (int t = 0; t < tasks; ++t) {
        row.push_back(estimate(made, p, metric, {t}));
        if (made.tasks[static_cast<std::size_t>(t)].baseline == kAbsent || made.is_adaptive(p)) continue;
        DeltaRow delta{p, t, metric, variant_contrast(made, p, metric, t), false};
        if (delta.contrast.first.n > 0 && delta.contrast.second.n > 0)
          tables.deltas.push_back(std::move(delta));
      }
      for (std::size_t i = first; i < tables.deltas.size(); ++i)
        family.push_back(&tables.deltas[i].contrast);
      adjust(family, Adjustment::kBenjaminiHochberg);
    }
  }
  return tables;
}

}  // namespace

Benchmark benchmark_of_events(const Benchmark& benchmark, const ToldEvents& events) {
  Benchmark out;
  for (const std::string& name : events.metrics.events) out.metrics.push_back({name, true, -1});
  for (const std::string& name : events.metrics.subgoals) out.metrics.push_back({name, true, 0});
  out.objects = benchmark.objects;
  out.tasks = benchmark.tasks;
  for (Task& task : out.tasks) task.metrics.clear();
  out.categories = benchmark.categories;
  out.plans = benchmark.plans;
  out.policies = benchmark.policies;
  out.prompts = benchmark.prompts;
  out.reasons = benchmark.reasons;
  out.reasons.emplace_back("no events were read");
  out.episodes = benchmark.episodes;
  out.first = benchmark.first;
  for (std::size_t i = 0; i < out.episodes.size(); ++i) {
    Episode& episode = out.episodes[i];
    episode.truths = {};
    const auto& told = events.told[i];
    if (!told || !told->untold.empty()) {
      if (episode.valid()) {
        episode.reason = static_cast<int>(out.reasons.size()) - 1;
        episode.is_open = true;  // what happened in it may have been either
      }
      continue;
    }
    for (const rejudge::EventCount& count : told->counts)
      set(out, episode, count.name, count.value.value_or(0) > 0);
    for (int k = 0; k < told->subgoals; ++k)
      set(out, episode, told->firsts[static_cast<std::size_t>(k)].first, told->reached > k);
  }
  for (Task& task : out.tasks) std::ranges::sort(task.metrics);
  return out;
}

Json events_json(const Benchmark& benchmark, const ToldEvents& events) {
  if (events.told.size() != benchmark.episodes.size()) return nullptr;
  const Benchmark made = benchmark_of_events(benchmark, events);
  const bool has_any = std::ranges::any_of(
      made.episodes, [](const Episode& e) { return e.valid() && e.truths.any(); });
  if (!has_any) return nullptr;
  PageOptions options;
  options.models = false;
  const Json all = tables_json(made, tables_of(made), options);
  Json names = Json::array();
  for (std::size_t m = 0; m < made.metrics.size(); ++m) {
    names.push_back({{"name", made.metrics[m].name},
                     {"label", rejudge::event_words(made.metrics[m].name)},
                     {"subgoal", m >= events.metrics.events.size()}});
  }
  Json out = {{"names", std::move(names)}};
  out["main"] = all.at("main").at("rows");
  for (const char* key : {"by_task", "deltas"}) out[key] = all.at(key);
  out["numbers"] = numbers_json(benchmark, events);
  return out;
}

}  // namespace probe::report
