// Every number of a report: counts with intervals, differences with tests. Plain tables that the
// page, CSV, JSON, LaTeX and `compare` print.
#pragma once

#include <cstdint>
#include <optional>
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

// The difference of two rates, on the same starts where there are such.
struct Contrast {
  stats::PairTable pairs;  // of episodes; empty when not paired
  stats::Count first, second;
  std::int64_t starts = 0;  // rows of task and start
  // First less second, in episodes, by place of start: the clusters whose signs the test of a
  // paired contrast flips; in the order of tasks and starts.
  std::vector<std::int64_t> place_nets;
  bool paired = true;
  double difference = 0;     // first - second
  stats::Interval interval;  // 95 %
  double p = 1;              // exact: sign flips, or dealing out unpaired starts
  double adjusted = 1;       // for the table's family, see there
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
  std::optional<double> detectable;  // with 80 % power, at the share of pairs that differ
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
// A paired contrast as its test sees it: one outcome a place. `discordance` is the share of places
// with a winner; `episodes` turns a difference of shares of places into one of rates.
struct PlaceDesign {
  std::int64_t places = 0, differ = 0;
  double discordance = 0;
  double episodes = 1;
};
PlaceDesign place_design(const Contrast& contrast);

// The difference of rates that a comparison with as many places, of which as many differ by as
// much, finds with 80 % power; nothing when not even the largest difference.
std::optional<double> detectable(const Contrast& contrast);

}  // namespace probe::report
