// Looks an episode up in a run's folder.
#include "runtime/run/recorded.h"

#include <algorithm>
#include <set>

#include "runtime/robot/laws.h"
#include "runtime/store/episode_key.h"
#include "runtime/store/proof.h"
#include "runtime/store/store.h"
#include "runtime/store/stored_trace.h"

namespace probe::run {

PolicyContext policy_context() {
  PolicyContext context;
  context.recorded_actions = [](const std::string& dir, std::string_view task, int episode,
                                int seed) -> Result<policy::RecordedEpisode> {
    PROBE_ASSIGN(const store::StoredTrace found,
                 store::find_trace(dir, std::string(task), episode, seed));
    policy::RecordedEpisode recorded;
    for (const store::TraceStep& step : found.trace.steps) recorded.actions.push_back(step.action);
    if (found.trace.header.joint_actions)
      recorded.joint_law = found.trace.header.joint_actions->law;
    return recorded;
  };
  return context;
}

Result<std::shared_ptr<const servers::RecordedEpisodes>> recorded_episodes(const std::string& dir) {
  PROBE_ASSIGN(const auto proven, store::read_proven_results(dir));
  auto episodes = std::make_shared<servers::RecordedEpisodes>();
  for (const store::ResultRow& row : proven.rows) {
    if (row.invalid) continue;
    const std::string key = servers::episode_key(row.image_sha256, row.prompt_sha256);
    PROBE_ASSIGN(const store::Trace trace, store::read_stored_trace(row));
    std::vector<policy::Action> actions;
    for (const store::TraceStep& step : trace.steps) actions.push_back(step.action);
    const auto [there, is_new] = episodes->try_emplace(key, actions);
    if (is_new || there->second == actions) continue;
    return Failure{Fault::kUsage,
                   to_text(store::key_of(row)) +
                       " begins as one of another seed and goes on otherwise, so that which is "
                       "asked for cannot be told: serve a run of one seed",
                   dir};
  }
  if (episodes->empty()) return Failure{Fault::kUsage, "has no valid episode to serve", dir};
  return std::shared_ptr<const servers::RecordedEpisodes>(std::move(episodes));
}

Result<std::shared_ptr<const servers::RecordedEpisodes>> recorded_steps(const std::string& dir,
                                                                        int most) {
  PROBE_ASSIGN(const auto proven, store::read_proven_results(dir));
  auto steps = std::make_shared<servers::RecordedEpisodes>();
  std::set<std::string> ambiguous;
  for (const store::ResultRow& row : proven.rows) {
    if (row.invalid) continue;
    PROBE_ASSIGN(const store::Trace trace, store::read_stored_trace(row));
    for (std::size_t i = 0; i < trace.steps.size(); ++i) {
      const std::size_t end = std::min(trace.steps.size(), i + static_cast<std::size_t>(most));
      std::vector<policy::Action> actions;
      for (std::size_t k = i; k < end; ++k) actions.push_back(trace.steps[k].action);
      const std::string key =
          servers::episode_key(to_hex(trace.steps[i].image_hash), row.prompt_sha256);
      const auto [there, is_new] = steps->try_emplace(key, actions);
      if (is_new) continue;
      // A robot at rest looks the same in several steps, of which the last have less before them.
      std::vector<policy::Action>& known = there->second;
      const std::size_t common = std::min(known.size(), actions.size());
      if (!std::equal(known.begin(), known.begin() + static_cast<std::ptrdiff_t>(common),
                      actions.begin())) {
        ambiguous.insert(key);
      } else if (actions.size() > known.size()) {
        known = std::move(actions);
      }
    }
  }
  for (const std::string& key : ambiguous) steps->erase(key);
  if (steps->empty() && !ambiguous.empty()) {
    return Failure{Fault::kUsage,
                   "has no step that its picture tells from all others, so none can be served in "
                   "batches",
                   dir};
  }
  if (steps->empty()) return Failure{Fault::kUsage, "has no valid episode to serve", dir};
  return std::shared_ptr<const servers::RecordedEpisodes>(std::move(steps));
}

Result<StoredActions> only_actions(const std::string& dir) {
  PROBE_ASSIGN(const auto rows, store::read_results(dir));
  std::optional<std::pair<std::string, std::uint32_t>> known;  // law, numbers of an action
  std::set<std::string> tasks;
  for (const store::ResultRow& row : rows) {
    // A task has one robot.
    if (row.invalid || !tasks.insert(row.task).second) continue;
    PROBE_ASSIGN(const store::Trace trace, store::read_stored_trace(row));
    const auto& joints = trace.header.joint_actions;
    const std::pair<std::string, std::uint32_t> here(joints ? joints->law : std::string(),
                                                     joints ? joints->count : 0);
    if (known && *known != here) {
      return Failure{Fault::kUsage,
                     "has actions of several laws or arms, and a server answers in those of one: "
                     "run the tasks of "
                     "one robot into a folder of their own",
                     dir};
    }
    known = here;
  }
  if (!known) return StoredActions{};
  const robot::KindRow* kind = robot::find_kind(known->first);
  if (kind == nullptr) return StoredActions{};
  return StoredActions{kind->layout == robot::ActionLayout::kJoints
                           ? servers::ActionForm::kJoints
                           : servers::ActionForm::kJointSteps,
                       static_cast<int>(known->second) - 1};  // behind them the gripper's
}

Result<std::optional<int>> only_seed(const std::string& dir) {
  PROBE_ASSIGN(const store::RunRecord record, store::read_run_record(dir));
  PROBE_ASSIGN(const auto rows, store::read_results(dir));
  const std::string& content = record.identity.policy_content;
  const bool is_named = content.starts_with(store::kOwnPolicy);
  const auto choice =
      choose_policy(is_named ? content.substr(store::kOwnPolicy.size()) : record.identity.policy);
  if (!choice || !choice->traits.draws) return std::optional<int>();
  std::set<int> seeds;
  for (const store::ResultRow& row : rows) seeds.insert(row.seed);
  return seeds.size() == 1 ? std::optional<int>(*seeds.begin()) : std::nullopt;
}

}  // namespace probe::run
