#include "runtime/run/callers_proof.h"

#include <algorithm>
#include <memory>
#include <optional>
#include <string>

#include "runtime/base/asset_root.h"
#include "runtime/plan/plan.h"
#include "runtime/run/changed_folder.h"
#include "runtime/run/episode.h"
#include "runtime/run/recorded.h"
#include "runtime/stage/assets.h"
#include "runtime/store/results.h"
#include "runtime/store/stored_trace.h"
#include "runtime/store/trace_compare.h"

namespace probe::run {
namespace {

// Hands questions on and holds the answers against a trace's; the first other one ends the episode.
class Compared final : public policy::Policy {
 public:
  Compared(std::unique_ptr<policy::Policy> asked, const store::Trace& trace)
      : asked_(std::move(asked)), trace_(trace) {}

  Status begin(const policy::EpisodeStart& start) override { return asked_->begin(start); }
  Result<policy::Action> act(const policy::Observation& seen) override {
    auto said = asked_->act(seen);
    const auto step = static_cast<std::size_t>(seen.step);
    if (said && step < trace_.steps.size() && *said == trace_.steps[step].action) return said;
    difference_ = "step " + std::to_string(step) + " was answered otherwise";
    if (!said) difference_ = "step " + std::to_string(step) + ": " + to_text(said.failure());
    return Failure{Fault::kPolicy, difference_, ""};
  }
  void end(const policy::EpisodeEnd& end) override { asked_->end(end); }

  const std::string& difference() const { return difference_; }

 private:
  std::unique_ptr<policy::Policy> asked_;
  const store::Trace& trace_;
  std::string difference_;
};

}  // namespace

Status check_callers_policy(const plan::Plan& plan, const RunOptions& options, const Actor& actor,
                            std::vector<std::string>& notes) {
  PROBE_ASSIGN(const auto rows, store::read_results(options.out));
  const auto row = std::ranges::find_if(
      rows, [](const store::ResultRow& one) { return !one.invalid && one.steps > 0; });
  if (row == rows.end()) return {};
  const auto task = plan.find_task(row->task);
  if (!task) return {};  // the folder is of another plan; continuing it was refused
  PROBE_ASSIGN(const store::Trace trace, store::read_stored_trace(*row));
  const EpisodeJob job{*task, static_cast<std::uint32_t>(row->episode), row->seed};

  PROBE_ASSIGN(const AssetRoot root, find_asset_root(options.assets));
  const std::uint32_t tasks[] = {*task};
  PROBE_ASSIGN(auto assets, stage::SharedAssets::load(plan, root, tasks));
  PROBE_ASSIGN(auto stage, stage::Stage::create(plan, *task, std::move(assets)));
  PROBE_ASSIGN(auto made, actor.make(policy_context()));
  Compared policy(std::move(made), trace);
  store::TraceComparer comparer(trace);
  PROBE_ASSIGN(const Played played,
               run_episode(*stage, plan, job, trace.header.policy, policy, comparer, nullptr,
                           static_cast<int>(trace.steps.size())));
  const Failure stopped{Fault::kUsage, "stopped; the same call continues", options.out};
  if (options.stopped && options.stopped()) return stopped;
  // Another build's world, which the folder is continued over, may show other pictures.
  std::string difference = policy.difference();
  if (difference.empty() && played.row.invalid) difference = *played.row.invalid;
  if (difference.empty()) return {};
  const std::string said = "was begun with a policy of the same name that did " +
                           to_text(store::key_of(*row)) +
                           " otherwise than the caller's does now (" + difference +
                           "): it is another one, or one that draws or rounds otherwise";
  return goes_on_mixed(options.out, said, options.if_changed, notes,
                       "; `content`, given from the first call on, says which policy it is");
}

}  // namespace probe::run
