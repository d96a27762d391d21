// Looks an episode up in a run's folder.
#include "runtime/run/recorded.h"

#include <algorithm>

#include "runtime/store/stored_trace.h"

namespace probe::run {

PolicyContext policy_context() {
  PolicyContext context;
  context.recorded_actions = [](const std::string& dir, std::string_view task, int episode,
                                int seed) -> Result<std::vector<policy::Action>> {
    PROBE_ASSIGN(const store::StoredTrace found,
                 store::find_trace(dir, std::string(task), episode, seed));
    std::vector<policy::Action> actions;
    for (const store::TraceStep& step : found.trace.steps) actions.push_back(step.action);
    return actions;
  };
  return context;
}

}  // namespace probe::run
