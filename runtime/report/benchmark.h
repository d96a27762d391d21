// Run folders as one table of episodes: policies, tasks, starts, categories and what could not be
// used. Reads databases and plans, never traces.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "runtime/adaptive/rule.h"
#include "runtime/adaptive/sampled.h"
#include "runtime/base/result.h"
#include "runtime/plan/plan.h"
#include "runtime/report/asked_model.h"
#include "runtime/store/not_attempted.h"
#include "runtime/store/results.h"
#include "runtime/store/run_record.h"

namespace probe::report {

// Indices of tables below; kAbsent where there is none.
inline constexpr int kAbsent = -1;

struct Metric {
  std::string name;
  bool truth = true;
  int good = 0;  // +1 higher is better, -1 lower, 0 neither
};

struct Object {
  std::string name;
  std::optional<bool> seen_as_source, seen_as_target;  // in training
};

struct StartPlace {
  std::string start_id, episode_id;  // hex
  std::uint32_t cluster = 0;         // starts of any task that lie in the same places share it
  std::uint32_t taken = 0;           // the same whichever thing has which role (plan::taken_key)
  std::vector<std::array<double, 3>> bodies;  // x, y (m), yaw (deg): as the task's bodies
};

// Tasks of several plans are one if name, instruction, judge, source and target agree; their starts
// are told apart by content.
struct Task {
  std::string name, prompt, scene;
  std::vector<std::string> later;  // sentences behind the prompt, where it changes
  int plan = 0;
  int baseline = kAbsent;
  std::uint32_t axes = 0;  // mask of plan::Axis, against the baseline
  std::vector<std::string> axis_names;
  int source = kAbsent, target = kAbsent;
  struct NamedRole {
    std::string name;  // "helper"; empty: what the layout placed by name
    std::vector<int> objects;
  };
  std::vector<NamedRole> roles;  // beside them
  std::vector<int> distractors;
  std::vector<std::string> ood;  // "source", "target", "relation"
  int horizon = 0;               // control steps
  double hz = 0;
  std::vector<int> metrics;
  std::string allowed;  // reason of an allowed confounded comparison
  std::string
      confounded;        // why the comparison with the baseline says nothing of one axis; or empty
  std::string unpaired;  // why its starts do not correspond to the baseline's; or empty
  std::string rule_file, rule;  // of success, as written
  int rule_line = 0;
  std::vector<StartPlace> starts;
};

struct Category {
  std::string name, label;
  std::vector<int> tasks;
};

struct PlanInfo {
  std::string root, suite, trained_on;
  int tasks = 0, starts = 0;  // of the suite that was run
  int seeds = 1;              // of the suite as declared
};

struct RunInfo {
  std::string dir;
  int plan = 0, fingerprint = 0;
  std::vector<int> seeds;
  int done = 0, expected = 0, invalid = 0, videos = 0;
  store::NotAttempted not_attempted = {};  // not among the invalid
  int tasks = 0;                           // that have an episode
  store::ReadingSummary reading = {};      // of a policy server
  std::string content = {};                // RunIdentity::policy_content
  std::string live = {};                   // of a world that does not wait: how the policy answered
};

enum class Role : std::uint8_t { kModel, kCeiling, kFloor, kRandom, kProbe };
std::string_view to_text(Role role);

// A run that stops by what it finds: only episodes that count (adaptive/sampled.h) are in the
// benchmark, and no test or interval of a fixed number is made of them.
struct AdaptivePolicy {
  adaptive::Rule rule;
  stats::Drawing drawing = stats::Drawing::kAnyhow;
  struct Place {
    int task = 0, start = 0, seed = 0;
    bool operator==(const Place&) const = default;
  };
  std::vector<Place> order = {};  // of all that could have been run
  std::vector<int> seeds = {};    // of these, ascending
  std::vector<std::vector<std::size_t>> by_task = {};  // places, see index_episodes

  std::span<const std::size_t> places_of(int task) const {
    const auto at = static_cast<std::size_t>(task);
    return at < by_task.size() ? std::span(by_task[at]) : std::span<const std::size_t>();
  }
};

struct Policy {
  std::string name, label;  // labels are unique
  Role role = Role::kModel;
  std::vector<RunInfo> runs;
  std::optional<AdaptivePolicy> adaptive = {};  // then it has one run
};

// Which truths hold, by metric; those behind the last one that does are false. Most plans have few.
class Truths {
 public:
  bool operator[](std::size_t metric) const {
    if (metric < 64) return (low_ >> metric & 1) != 0;
    const std::size_t word = metric / 64 - 1;
    return word < high_.size() && (high_[word] >> metric % 64 & 1) != 0;
  }
  void set(std::size_t metric, bool truth = true) {
    std::uint64_t* word = &low_;
    if (metric >= 64) {
      if (high_.size() < metric / 64) high_.resize(metric / 64);
      word = &high_[metric / 64 - 1];
    }
    const std::uint64_t bit = std::uint64_t{1} << metric % 64;
    *word = truth ? *word | bit : *word & ~bit;
  }
  std::size_t size() const { return 64 * (1 + high_.size()); }  // none at or behind it
  bool any() const {
    return low_ != 0 || std::any_of(high_.begin(), high_.end(), [](auto word) { return word != 0; });
  }

 private:
  std::uint64_t low_ = 0;
  std::vector<std::uint64_t> high_;
};

// Small, since there may be a million of them.
struct Episode {
  int policy = 0, task = 0, start = 0, seed = 0;
  Truths truths = {};    // of the benchmark's metrics
  int reason = kAbsent;  // of invalidity
  int prompt = kAbsent;  // what the policy was sent, if its hash fits a known instruction
  int plan = 0;          // under which it was run
  int steps = 0;
  int remark = kAbsent;              // of Benchmark::remarks
  int row = kAbsent;                 // of Benchmark::rows, where it was kept
  bool is_open = false;              // store::is_open
  bool is_prompted = false;          // an instruction was sent
  std::uint64_t picture = 0;         // of the first one's hash; 0: none was sent
  std::uint64_t trace = 0;           // the first 48 bits of its trace's hash
  std::vector<double> numbers = {};  // of the metrics that are no truths, in their order; NaN: none
  std::string video = {};            // path, or empty
  // Episodes of several tasks with one number are one observation, which no sum counts twice; -1:
  // this one stands for itself.
  std::int64_t shared = -1;

  bool valid() const { return reason == kAbsent; }
  bool is(int metric) const { return metric >= 0 && truths[static_cast<std::size_t>(metric)]; }
};

struct Note {
  std::string level;  // "note", "warn", "bad"
  std::string text;
};

struct Benchmark {
  std::vector<Metric> metrics;  // truths first
  std::vector<Object> objects;
  std::vector<Task> tasks;
  std::vector<Category> categories;
  std::vector<PlanInfo> plans;
  std::vector<std::vector<std::pair<std::string, std::string>>> fingerprints;
  std::vector<std::string> fingerprint_differences;
  std::vector<Policy> policies;
  std::vector<AskedModel> models;  // that were asked about tasks
  std::vector<std::string> prompts, reasons, remarks;
  std::vector<Episode> episodes;  // ascending by policy, task, start, seed
  // As stored: of all episodes, or of many some of each task, see LoadOptions::most_rows.
  std::vector<store::ResultRow> rows;
  std::vector<Note> notes;
  std::size_t unborne = 0;  // rows that their traces do not bear: in no number, named in the notes
  std::vector<plan::Plan> plan_files;  // by plan

  int find_metric(std::string_view name) const;
  int find_task(std::string_view name) const;
  std::span<const Episode> of(int policy, int task) const;
  std::vector<int> all_tasks() const;
  bool is_adaptive(int policy) const {
    return policies[static_cast<std::size_t>(policy)].adaptive.has_value();
  }
  bool has_adaptive() const {
    return std::ranges::any_of(policies, [](const Policy& p) { return p.adaptive.has_value(); });
  }

  std::vector<std::size_t> first;  // episode of policy * tasks + task, and the end
  // What its episodes are called in sentences.
  std::string_view things = "episodes";
};

// Puts the episodes in their order and finds the first of each policy and task.
void index_episodes(Benchmark& benchmark);

// What a task is called whose name means another task in a plan before: "stack_cube (plan
// 4385c74b)".
std::string name_apart(const std::string& task, const std::string& root);

struct LoadOptions {
  std::vector<std::string> sets = {};  // columns of the tables; empty: the plan's finest sets
  bool join = true;                    // runs of one policy that do not overlap are one policy's
  bool prove = false;  // leave out, and name in a note, rows that their traces do not bear
  // Of so many episodes all rows are kept as they are stored; of more, in each folder some of each
  // task: those of its first failures and successes.
  std::size_t most_rows = 100'000;
};

// Folders of runs, and of answers. Those that cannot be read are a failure that names the folder;
// what can be read but not used is a note.
Result<Benchmark> load(std::span<const std::string> dirs, const LoadOptions& options = {});

}  // namespace probe::report
