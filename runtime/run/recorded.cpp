// Looks an episode up in a run's folder.
#include "runtime/run/recorded.h"

#include <algorithm>

#include "runtime/store/proof.h"
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

Result<std::shared_ptr<const servers::RecordedEpisodes>> recorded_episodes(const std::string& dir) {
  PROBE_ASSIGN(const auto proven, store::read_proven_results(dir));
  auto episodes = std::make_shared<servers::RecordedEpisodes>();
  for (const store::ResultRow& row : proven.rows) {
    if (row.invalid) continue;
    const std::string key = servers::episode_key(row.image_sha256, row.prompt_sha256);
    if (episodes->contains(key)) continue;
    PROBE_ASSIGN(const store::Trace trace, store::read_stored_trace(row));
    for (const store::TraceStep& step : trace.steps) (*episodes)[key].push_back(step.action);
  }
  if (episodes->empty()) return Failure{Fault::kUsage, "has no valid episode to serve", dir};
  return std::shared_ptr<const servers::RecordedEpisodes>(std::move(episodes));
}

}  // namespace probe::run
