#include "runtime/report/gate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "runtime/report/tables.h"
#include "runtime/stats/betting.h"
#include "runtime/stats/multiplicity.h"

namespace probe::report {
namespace {

constexpr int kNow = 0, kBefore = 1;  // policies of the benchmark

Result<int> metric_of(const Benchmark& benchmark, const std::string& name) {
  const int metric = benchmark.find_metric(name);
  if (metric == kAbsent || !benchmark.metrics[static_cast<std::size_t>(metric)].truth) {
    std::string known;
    for (const Metric& m : benchmark.metrics) {
      if (m.truth && m.good != 0) known += (known.empty() ? "`" : ", `") + m.name + "`";
    }
    return Failure{Fault::kUsage, "no metric `" + name + "` that is true or false; there are " + known,
                   ""};
  }
  if (benchmark.metrics[static_cast<std::size_t>(metric)].good == 0)
    return Failure{Fault::kUsage, "neither more nor less of `" + name + "` is better", ""};
  return metric;
}

using Key = std::pair<int, int>;  // start, seed

// Episodes that both have run and that lack a verdict in one: what they would be at the worst.
struct Hidden {
  std::int64_t count = 0;
  std::vector<stats::PlacedPairs> rows;  // one an episode
};

Hidden hidden_in(const Benchmark& benchmark, int metric, bool lower_is_better,
                 const std::vector<int>& tasks) {
  Hidden hidden;
  for (const int task : tasks) {
    std::map<Key, const Episode*> before;
    for (const Episode& e : benchmark.of(kBefore, task)) before[{e.start, e.seed}] = &e;
    for (const Episode& now : benchmark.of(kNow, task)) {
      const auto found = before.find({now.start, now.seed});
      if (found == before.end() || (now.valid() && found->second->valid())) continue;
      const bool was = found->second->valid() ? found->second->is(metric) : !lower_is_better;
      const bool is = now.valid() ? now.is(metric) : lower_is_better;
      ++hidden.count;
      stats::PlacedPairs row;
      count_pair(row.pairs, is, was);
      hidden.rows.push_back(row);
    }
  }
  return hidden;
}

std::vector<stats::BoundedOutcome> outcomes_of(const std::vector<stats::PlacedPairs>& rows,
                                               bool lower_is_better) {
  std::int64_t largest = 1;
  for (const auto& row : rows) largest = std::max(largest, row.pairs.pairs());
  std::vector<stats::BoundedOutcome> outcomes;
  for (const auto& row : rows) {
    const double size = static_cast<double>(row.pairs.pairs());
    const double net = static_cast<double>(row.pairs.net());
    outcomes.push_back({(lower_is_better ? -net : net) / size, size / static_cast<double>(largest)});
  }
  return outcomes;
}

double p_of_allowed(const std::vector<stats::BoundedOutcome>& outcomes, double allow) {
  return std::min(1.0, std::exp(-stats::log_evidence_below(outcomes, -allow)));
}

// Chance of so much evidence where the drop is more than is allowed.
double p_of_more(std::vector<stats::BoundedOutcome> outcomes, double allow) {
  for (stats::BoundedOutcome& outcome : outcomes) outcome.value = -outcome.value;
  return std::min(1.0, std::exp(-stats::log_evidence_below(outcomes, allow)));
}

struct Measured {
  GateRow row;
  double p_of_more = 1;
  double p_at_worst = 1;  // were all hidden episodes as bad as can be
  std::int64_t hidden = 0;
};

Measured measure(const Benchmark& benchmark, int metric, const GateOptions& options,
                 const std::string& name, const std::vector<int>& tasks) {
  const bool lower = benchmark.metrics[static_cast<std::size_t>(metric)].good < 0;
  Measured out;
  out.row.name = name;
  std::vector<stats::PlacedPairs> rows = policy_pairs(benchmark, kNow, kBefore, metric, tasks).rows();
  for (const auto& row : rows) {
    out.row.episodes += row.pairs.pairs();
    out.row.now += row.pairs.both + row.pairs.only_a;
    out.row.before += row.pairs.both + row.pairs.only_b;
  }
  out.row.starts = static_cast<std::int64_t>(rows.size());
  const auto outcomes = outcomes_of(rows, lower);
  if (out.row.episodes > 0) {
    const double net = static_cast<double>(out.row.before - out.row.now);
    out.row.drop = (lower ? -net : net) / static_cast<double>(out.row.episodes);
  }
  // Either bound alone is that sure, as the verdicts are.
  const stats::Interval mean = stats::bounds_by_betting(outcomes, 1 - 2 * options.error);
  out.row.low = -mean.high;
  out.row.high = -mean.low;
  out.row.p = p_of_allowed(outcomes, options.allow);
  out.p_of_more = p_of_more(outcomes, options.allow);
  const Hidden hidden = hidden_in(benchmark, metric, lower, tasks);
  out.hidden = hidden.count;
  rows.insert(rows.end(), hidden.rows.begin(), hidden.rows.end());
  out.p_at_worst = p_of_allowed(outcomes_of(rows, lower), options.allow);
  return out;
}

// All rows are one family: whichever is falsely called worse, it is one error.
void decide(std::vector<Measured>& rows, const GateOptions& options) {
  std::vector<double> allowed, more, worst;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    allowed.push_back(rows[i].row.p);
    more.push_back(rows[i].p_of_more);
    worst.push_back(rows[i].p_at_worst);
  }
  allowed = stats::holm(allowed);
  more = stats::holm(more);
  worst = stats::holm(worst);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    GateRow& row = rows[i].row;
    row.p = allowed[i];
    rows[i].p_at_worst = worst[i];
    if (row.p <= options.error) {
      row.verdict = Verdict::kWorse;
    } else if (more[i] <= options.error) {
      row.verdict = Verdict::kNotWorse;
    }
  }
}

void note_runs(const Benchmark& benchmark, Gate& gate) {
  for (const Note& note : benchmark.notes) {
    if (note.level == "bad") gate.notes.push_back(note.text);
  }
  for (const int policy : {kNow, kBefore}) {
    const Policy& of = benchmark.policies[static_cast<std::size_t>(policy)];
    for (const RunInfo& run : of.runs) {
      if (run.done < run.expected)
        gate.notes.push_back(fmt::format("{} of {} episodes of `{}` have been run", run.done,
                                         run.expected, of.label));
    }
  }
}

}  // namespace

std::string_view to_text(Verdict verdict) {
  switch (verdict) {
    case Verdict::kWorse: return "worse";
    case Verdict::kNotWorse: return "not worse";
    case Verdict::kUndecided: break;
  }
  return "undecided";
}

bool Gate::is_worse() const {
  return std::any_of(rows.begin(), rows.end(),
                     [](const GateRow& row) { return row.verdict == Verdict::kWorse; });
}

bool Gate::is_decided() const {
  return std::none_of(rows.begin(), rows.end(),
                      [](const GateRow& row) { return row.verdict == Verdict::kUndecided; });
}

Result<Gate> gate(const Benchmark& benchmark, const GateOptions& options) {
  if (!(options.allow >= 0 && options.allow < 1))
    return Failure{Fault::kUsage, "--allow is a share of the episodes, 0 to below 100 %", ""};
  if (!(options.error > 0 && options.error < 0.5))
    return Failure{Fault::kUsage, "--error is a chance above 0 and below 50 %", ""};
  for (const int policy : {kNow, kBefore}) {
    if (!benchmark.is_adaptive(policy)) continue;
    const Policy& of = benchmark.policies[static_cast<std::size_t>(policy)];
    return Failure{Fault::kUsage,
                   "nothing is said: " + adaptive::why_not_fixed(to_text(of.adaptive->rule)) +
                       "; `run --until none` runs the others, and `compare` says what is decided",
                   of.runs.empty() ? of.label : of.runs.front().dir};
  }
  PROBE_ASSIGN(const int metric, metric_of(benchmark, options.metric));
  std::vector<Measured> measured;
  measured.push_back(measure(benchmark, metric, options, "all tasks", benchmark.all_tasks()));
  if (measured.front().row.episodes == 0) {
    return Failure{Fault::kUsage, "the two runs share no valid episode: other tasks, starts or seeds",
                   ""};
  }
  if (options.categories) {
    for (const Category& category : benchmark.categories) {
      Measured row = measure(benchmark, metric, options, category.label, category.tasks);
      if (row.row.episodes > 0) measured.push_back(std::move(row));
    }
  }
  decide(measured, options);
  Gate out;
  out.options = options;
  out.now = benchmark.policies[kNow].label;
  out.before = benchmark.policies[kBefore].label;
  out.lower_is_better = benchmark.metrics[static_cast<std::size_t>(metric)].good < 0;
  note_runs(benchmark, out);
  out.unborne = benchmark.unborne;
  for (const Measured& one : measured) {
    if (one.row.verdict != Verdict::kWorse && one.p_at_worst <= options.error) {
      return Failure{Fault::kUsage,
                     fmt::format("{}: {} episodes that both have run are invalid in one of them, and "
                                 "a drop of more than is allowed may hide there: nothing is said",
                                 one.row.name, one.hidden),
                     ""};
    }
    out.rows.push_back(one.row);
  }
  if (measured.front().hidden > 0) {
    out.notes.push_back(fmt::format("{} episodes that both have run are invalid in one of them; no "
                                    "verdict turns worse if each of them is as bad as can be",
                                    measured.front().hidden));
  }
  return out;
}

Result<Gate> gate_folders(const std::string& now, const std::string& before,
                          const GateOptions& options) {
  const std::vector<std::string> dirs = {now, before};
  PROBE_ASSIGN(const Benchmark benchmark,
               load(dirs, {.sets = options.sets, .join = false, .prove = true}));
  if (!benchmark.models.empty())
    return Failure{Fault::kUsage, "holds a model's answers: `gate` compares runs of policies", now};
  if (benchmark.policies.size() < 2)
    return Failure{Fault::kUsage, "is the same folder twice: there is nothing to compare", now};
  return gate(benchmark, options);
}

}  // namespace probe::report
