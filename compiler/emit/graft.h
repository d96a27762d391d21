// Metrics of a text for the tasks of a plan that is there already: what was recorded can be asked
// what its suite did not ask, without the suite's text and assets.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "compiler/emit/analyzed.h"
#include "runtime/base/result.h"
#include "runtime/plan/plan.h"

namespace probe {

// A metric that could not be measured in some of the plan's tasks.
struct MetricLeftOut {
  struct Task {
    std::string name, why;
  };
  std::string metric;
  std::vector<Task> tasks;  // in the plan's order
};

struct Grafted {
  // The plan again: each task with its own metrics and, behind them, those of the text. One of the
  // text replaces one of its name. Starts and words are as they were, so start and prompt ids are;
  // judge ids, episode ids and the root are others.
  std::vector<std::byte> plan;
  std::vector<std::string> metrics;  // of the text, in its order
  std::vector<MetricLeftOut> left_out;
};

// A set of metrics as the text declares it.
struct DeclaredMetrics {
  std::string name;
  std::vector<std::string> metrics;
};

// Whether the files that were named declare metrics, no task that has episodes and no suite: then
// another plan's tasks are judged by it. What they use, as for its fixtures, may have tasks.
bool is_metrics_alone(const AnalyzedText& text);
// The sets of metrics of the files that were named, in the order of the text; not those of files
// that they use.
std::vector<DeclaredMetrics> declared_metrics(const AnalyzedText& text);

// In: a text without mistakes, a plan. Metrics about what a task does not have (a target, fingers)
// are left out of that task. Fails (kUsage) when none fits any task, when two sets of the text have
// a metric of one name, and on one that reads `view_x` or its like, which are counted from a camera
// or robot of the text; and when the plan's program would become too long.
Result<Grafted> graft_metrics(const plan::Plan& stored, AnalyzedText text);

}  // namespace probe
