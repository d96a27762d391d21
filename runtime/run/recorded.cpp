// Looks an episode up in a run's folder.
#include "runtime/run/recorded.h"

#include <algorithm>
#include <set>

#include "runtime/robot/laws.h"
#include "runtime/stage/assets.h"
#include "runtime/stage/robot_of.h"
#include "runtime/store/episode_key.h"
#include "runtime/store/proof.h"
#include "runtime/store/run_plan.h"
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

namespace {

// Of a law and an arm of so many joints.
servers::ServedActions actions_of(const robot::KindRow& law, std::size_t arm_joints) {
  servers::ServedActions actions;
  if (law.per_joint) {
    actions.form = law.layout == robot::ActionLayout::kJoints ? servers::ActionForm::kJoints
                                                              : servers::ActionForm::kJointSteps;
    actions.arm_joints = static_cast<int>(arm_joints);
  }
  if (law.kind == robot::ControlKind::kEeDeltaInterpolated)
    actions.gripper = servers::GripperRange::kStep;
  return actions;
}

const plan::RobotRecord& robot_in(const plan::Plan& plan, std::uint32_t task) {
  return plan.robots()[plan.scenes()[plan.tasks()[task].scene].robot];
}

// Records count from 1.
const robot::KindRow& law_of(const plan::RobotRecord& robot) {
  return robot::control_kinds()[robot.control - 1];
}

// The one of all.
class Only {
 public:
  Status add(const servers::ServedActions& here, const std::string& where, const char* mend) {
    if (known_ && *known_ != here) {
      return Failure{
          Fault::kUsage,
          std::string(
              "has actions of several laws or arms, and a server answers in those of one: ") +
              mend,
          where};
    }
    known_ = here;
    return {};
  }
  servers::ServedActions get() const { return known_.value_or(servers::ServedActions{}); }

 private:
  std::optional<servers::ServedActions> known_;
};

}  // namespace

Result<servers::ServedActions> only_actions(const plan::Plan& plan,
                                            std::span<const std::uint32_t> tasks,
                                            const AssetRoot& assets) {
  Only only;
  std::set<const plan::RobotRecord*> seen;
  for (const std::uint32_t task : tasks) {
    const plan::RobotRecord& record = robot_in(plan, task);
    if (!seen.insert(&record).second) continue;
    const std::uint32_t one[] = {task};
    PROBE_ASSIGN(const auto loaded, stage::SharedAssets::load(plan, assets, one));
    PROBE_ASSIGN(const robot::Robot robot,
                 stage::robot_of(plan, record, *loaded->robot(record.urdf)));
    PROBE_TRY(only.add(actions_of(law_of(record), robot.control.arm_joints.size()),
                       "task `" + std::string(plan.text(plan.tasks()[task].name)) + "`",
                       "choose tasks of one robot with --tasks"));
  }
  return only.get();
}

Result<servers::ServedActions> only_actions(const std::string& dir) {
  PROBE_ASSIGN(const auto rows, store::read_results(dir));
  PROBE_ASSIGN(const plan::Plan plan, store::open_run_plan(dir));
  Only only;
  std::set<std::string> tasks;
  for (const store::ResultRow& row : rows) {
    // A task has one robot.
    if (row.invalid || !tasks.insert(row.task).second) continue;
    const auto task = plan.find_task(row.task);
    if (!task) continue;  // who reads the rows proves them
    PROBE_ASSIGN(const store::Trace trace, store::read_stored_trace(row));
    const auto& joints = trace.header.joint_actions;
    // Behind those of the joints an action has the gripper's.
    PROBE_TRY(only.add(actions_of(law_of(robot_in(plan, *task)), joints ? joints->count - 1 : 0),
                       dir, "run the tasks of one robot into a folder of their own"));
  }
  return only.get();
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
