// Every number of a report: counts with intervals, differences with tests. Plain tables that the
// page, CSV, JSON, LaTeX and `compare` print.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "runtime/report/benchmark.h"
#include "runtime/stats/clustered.h"

namespace probe::report {

// k of n valid episodes, with the interval of clustered_rate.
struct Estimate {
  stats::Count count;
  stats::Interval interval;
};

// A difference is real where its adjusted p is at most this.
inline constexpr double kAlpha = 0.05;

// What the data answer to one of the two questions of a difference (runtime/stats/questions.h).
struct Answer {
  stats::Interval interval;          // 95 %
  double p = 1;                      // exact: sign flips, or dealing out unpaired starts
  double adjusted = 1;               // for the table's family, see there
  std::int64_t family = 1;           // tests that it was adjusted for
  std::vector<std::int64_t> nets;    // first less second, in episodes, by unit: a start or a place;
                                     // empty when not paired
  std::optional<double> detectable;  // where it is not real: the difference that as many units,
                                     // with as many that differ, find with 80 % power
  std::optional<std::int64_t> more;  // where it is not real: the units that are missing for finding
                                     // the difference that was seen, adjusted, with 80 % power

  bool is_real() const { return adjusted <= kAlpha; }
};

// The difference of two rates, on the same starts where there are such.
struct Contrast {
  stats::PairTable pairs;  // of episodes; empty when not paired
  stats::Count first, second;
  std::int64_t starts = 0;  // rows of task and start
  bool paired = true;
  double difference = 0;  // first - second
  Answer here;            // on these starts; units place by place, in each the tasks in their order
  Answer anew;            // for starts never tried; places in the order of tasks and starts
};

struct MainRow {
  int policy = 0, metric = 0;
  std::optional<Estimate> all;                 // nothing: no valid episode
  std::vector<std::optional<Estimate>> cells;  // by category
};

// A variant against its baseline. `adjusted` after Benjamini and Hochberg over the tasks of one
// policy and metric.
struct DeltaRow {
  int policy = 0, task = 0, metric = 0;
  Contrast contrast;
  bool at_floor = false;  // the baseline never succeeds: nothing could be lost
};

// All variants of a category against their baselines; those whose starts do not correspond are left
// out. `adjusted` after Holm over the categories of one policy and metric.
struct CategoryDeltaRow {
  int policy = 0, category = 0, metric = 0;
  Contrast contrast;
  int left_out = 0;  // tasks
};

struct ObjectPairRow {
  int policy = 0, source = 0, target = 0, metric = 0;
  Estimate estimate;
  std::vector<std::string> ood;
};

struct ObjectRow {
  int policy = 0, object = 0, metric = 0;
  bool as_source = true, ood = false;
  Estimate estimate;
};

// Intention and success of the same episodes; first = intention.
struct GapRow {
  int policy = 0, category = kAbsent;  // kAbsent: all
  Contrast contrast;
  std::optional<Estimate> intention, success;
};

struct FloorRow {
  int task = 0, metric = 0;
  std::optional<Estimate> floor, ceiling;
  std::string note;
};

// Policy a against b. `adjusted` after Holm over all rows of one metric and kind of scope.
struct PolicyRow {
  int a = 0, b = 0, metric = 0, category = kAbsent;  // kAbsent: all
  Contrast contrast;
};

struct Tables {
  std::vector<MainRow> main;
  std::vector<std::vector<std::vector<std::optional<Estimate>>>> by_task;  // metric, policy, task
  std::vector<DeltaRow> deltas;
  std::vector<CategoryDeltaRow> category_deltas;
  std::vector<ObjectPairRow> pairs;
  std::vector<ObjectRow> objects;
  std::vector<GapRow> gap;
  std::vector<FloorRow> floors;
  std::vector<PolicyRow> policies;
};

// The metrics that tables are made of: success, intention, grasp, wrong, as far as there are such,
// else every truth.
std::vector<int> table_metrics(const Benchmark& benchmark);

Tables make_tables(const Benchmark& benchmark);

// Parts of it, for `compare` and tests.
std::optional<Estimate> estimate(const Benchmark& benchmark, int policy, int metric,
                                 const std::vector<int>& tasks);
Contrast variant_contrast(const Benchmark& benchmark, int policy, int metric, int task);
Contrast category_contrast(const Benchmark& benchmark, int policy, int metric,
                           const std::vector<int>& tasks, int& left_out);
Contrast policy_contrast(const Benchmark& benchmark, int a, int b, int metric,
                         const std::vector<int>& tasks);
// A paired contrast as one of its tests sees it: one outcome a unit. `discordance` is the share of
// units with a winner; `episodes` turns a difference of shares of units into one of rates.
struct UnitDesign {
  std::int64_t units = 0, differ = 0;
  double discordance = 0;
  double episodes = 1;
};
UnitDesign unit_design(const Contrast& contrast, const Answer& answer);

// Fills `detectable` and `more` of the answers that are not real; both adjusted before.
void say_what_would_tell(Contrast& contrast);

// Adjusts both answers of the contrasts of one family, each question for itself.
enum class Adjustment : std::uint8_t { kHolm, kBenjaminiHochberg };
void adjust(std::span<Contrast* const> family, Adjustment method);

}  // namespace probe::report
