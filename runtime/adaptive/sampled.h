// What may be said of a run that stops by what it finds: which of its episodes count, and the one
// place that says which interval a rate of its has. Whoever shows a rate of a folder asks here first.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "runtime/adaptive/decision.h"
#include "runtime/adaptive/outcome.h"
#include "runtime/adaptive/rule.h"
#include "runtime/base/result.h"
#include "runtime/stats/without_replacement.h"
#include "runtime/store/results.h"
#include "runtime/store/store.h"

namespace probe::adaptive {

// A folder's rule and order.
struct AdaptiveRun {
  Rule rule;
  std::vector<store::OrderedEpisode> order;
  // In turn where every call ended by itself or had one world: else some episodes may have been
  // begun and lost, and which task came next was not chosen by what is stored alone.
  stats::Drawing drawing = stats::Drawing::kAnyhow;
};

// Nothing where all episodes of the run in `dir` are run. Fails as read_run_record does, and on rules
// that this program does not know.
Result<std::optional<AdaptiveRun>> read_adaptive(const std::string& dir);

// Which places of the order count: those before the first that has no row, of each task where it
// stops by itself, else of all. `has_row` by place.
std::vector<bool> counted_places(const AdaptiveRun& run, const std::vector<bool>& has_row);

// What is known of a task for one metric.
struct SampledTask {
  // Of the whole order and of its beginning that counts; one list a seed where the rule takes a
  // start's seeds together, else one.
  std::vector<stats::Drawn> lists;
  std::int64_t not_attempted = 0;

  std::int64_t total() const;
  std::int64_t successes() const;
  std::int64_t failures() const;
  std::int64_t unknown() const;
  bool is_whole() const { return successes() + failures() + unknown() + not_attempted == total(); }
};

// Of several tasks as SampledTask has one: lists of episodes to be added up.
std::vector<int> seeds_of(std::span<const store::OrderedEpisode> order);
class Sampled {
 public:
  // The order's seeds, ascending.
  Sampled(Rule::Kind kind, std::vector<int> seeds);
  // One episode of the order; one that does not count is kAbsent.
  void add(SampledTask& task, int seed, Outcome outcome) const;

 private:
  std::size_t list_of(int seed) const;

  bool is_by_seed_;
  std::vector<int> seeds_;
};

// The rate of success, or of another metric, of all episodes that the order has of these tasks,
// weighted by how many those are: what a run of all would find.
struct SampledRate {
  double rate = 0;
  stats::Interval interval;
};
// Nothing where no interval can be vouched for: nothing counts yet of a task, or some of its episodes
// were not attempted and it is not clear how many more would not be.
std::optional<SampledRate> rate_of(const Rule& rule, stats::Drawing drawing,
                                   std::span<const SampledTask> tasks);

// A run so far, for `success`: what `run` says at its end, `results` and `follow` show.
struct TaskSummary {
  std::string name;
  SampledTask sampled;
  std::optional<SampledRate> rate;
};
struct Summary {
  std::string rule;
  std::int64_t planned = 0, counted = 0;
  std::int64_t beyond = 0;  // rows that do not count yet, since one before them is missing
  std::vector<TaskSummary> tasks;  // in the order of their first places
  std::optional<SampledRate> all;
  std::optional<Decision> decision;  // where the rule is one
  std::string against;
};
class Summarizer {
 public:
  explicit Summarizer(const AdaptiveRun& run);
  void add(const store::ResultRow& row);
  Summary summary() const;

 private:
  const AdaptiveRun& run_;
  std::vector<Outcome> outcomes_;                                // by place
  std::vector<std::pair<store::EpisodeKey, std::size_t>> places_;  // ascending
};

// How the row's episode ended for a metric; a valid row without it is unknown.
Outcome outcome_of(const store::ResultRow& row, std::string_view metric = "success");

// Lines for people: the rule; what was run of what; a line a task where they are few, else those with
// the widest intervals; all tasks; the decision.
std::vector<std::string> to_lines(const Summary& summary, bool is_long = false);

// One sentence for whoever leaves out tests and intervals of a fixed number of episodes.
std::string why_not_fixed(const std::string& until);

}  // namespace probe::adaptive
