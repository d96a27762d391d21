// Looks an episode up in a run's folder.
#include "runtime/run/recorded.h"

#include <algorithm>

#include "runtime/base/spelling.h"
#include "runtime/run/stored_trace.h"

namespace probe::run {

Result<StoredTrace> find_trace(const std::string& dir, const std::string& task, int episode,
                               std::optional<int> seed) {
  PROBE_ASSIGN(const auto rows, read_results(dir));
  const ResultRow* found = nullptr;
  bool has_task = false, has_episode = false;
  for (const ResultRow& row : rows) {
    if (row.task != task) continue;
    has_task = true;
    if (row.episode != episode) continue;
    has_episode = true;
    if (seed ? row.seed == *seed : found == nullptr) found = &row;
  }
  if (found == nullptr) {
    const std::string name = "task `" + task + "`";
    if (!has_task) {
      std::vector<std::string> names;
      for (const ResultRow& row : rows) names.push_back(row.task);
      return Failure{"usage", "this run has no " + name + did_you_mean(task, names), dir};
    }
    if (!has_episode) {
      return Failure{"usage", name + " has no stored episode " + std::to_string(episode), dir};
    }
    return Failure{"usage",
                   "episode " + std::to_string(episode) + " of " + name + " has no seed " +
                       std::to_string(*seed),
                   dir};
  }
  PROBE_ASSIGN(Trace trace, read_stored_trace(*found));
  return StoredTrace{*found, std::move(trace)};
}

policy::PolicyContext policy_context() {
  policy::PolicyContext context;
  context.recorded_actions = [](const std::string& dir, std::string_view task, int episode,
                                int seed) -> Result<std::vector<policy::Action>> {
    PROBE_ASSIGN(const StoredTrace found, find_trace(dir, std::string(task), episode, seed));
    std::vector<policy::Action> actions;
    for (const TraceStep& step : found.trace.steps) actions.push_back(step.action);
    return actions;
  };
  return context;
}

}  // namespace probe::run
