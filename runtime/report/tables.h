// Every number of a report: counts with intervals, differences with tests. Plain tables that the
// page, CSV, JSON, LaTeX and `compare` print.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "runtime/report/benchmark.h"
#include "runtime/report/contrast.h"
#include "runtime/stats/clustered.h"

namespace probe::report {

// k of n valid episodes, with the interval of clustered_rate, for starts never tried; of a policy that
// stops by what it finds with that of adaptive::rate_of, of all episodes it could have run.
struct Estimate {
  stats::Count count;
  stats::Interval interval;
  // Where it is not k / n, because unlike shares of tasks were run.
  std::optional<double> weighted = {};

  double rate() const { return weighted ? *weighted : count.rate(); }
};

// In percent with one decimal.
std::string rate_text(const Estimate& estimate);

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

// How an episode ended, for whoever asks what is known of a run that stops by what it finds.
adaptive::Outcome outcome_of(const Episode& episode, int metric);

Tables make_tables(const Benchmark& benchmark);

// Parts of it, for `compare` and tests.
std::optional<Estimate> estimate(const Benchmark& benchmark, int policy, int metric,
                                 const std::vector<int>& tasks);
Contrast variant_contrast(const Benchmark& benchmark, int policy, int metric, int task);
Contrast category_contrast(const Benchmark& benchmark, int policy, int metric,
                           const std::vector<int>& tasks, int& left_out);
PairRows policy_pairs(const Benchmark& benchmark, int a, int b, int metric,
                      const std::vector<int>& tasks);
Contrast policy_contrast(const Benchmark& benchmark, int a, int b, int metric,
                         const std::vector<int>& tasks);

}  // namespace probe::report
