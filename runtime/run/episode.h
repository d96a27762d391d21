// The loop of one episode: picture, observation, action, physics, judgement, trace. The only place
// where the world, the camera, the policy and the judge meet.
#pragma once

#include <string>

#include "runtime/base/result.h"
#include "runtime/plan/plan.h"
#include "runtime/policy/policy.h"
#include "runtime/show/frame_sink.h"
#include "runtime/stage/episode_world.h"
#include "runtime/stage/scene_view.h"
#include "runtime/store/results.h"
#include "runtime/store/trace.h"
#include "runtime/vm/judge.h"

namespace probe::run {

// Everything one worker needs for the episodes of a task; kept between episodes.
class TaskStage {
 public:
  static Result<std::unique_ptr<TaskStage>> create(
      const plan::Plan& plan, std::uint32_t task,
      std::shared_ptr<const stage::SharedAssets> assets);
  std::uint32_t task() const { return task_; }
  stage::EpisodeWorld& world() { return *world_; }
  stage::SceneView& view() { return *view_; }
  vm::Judge& judge() { return judge_; }

 private:
  TaskStage(const plan::Plan& plan, std::uint32_t task) : task_(task), judge_(plan, task) {}
  std::uint32_t task_;
  std::unique_ptr<stage::EpisodeWorld> world_;
  std::unique_ptr<stage::SceneView> view_;
  vm::Judge judge_;
};

struct EpisodeJob {
  std::uint32_t task = 0;   // index of the plan's tasks
  std::uint32_t index = 0;  // within the task
  int seed = 0;
  bool operator==(const EpisodeJob&) const = default;
};

// First 8 bytes of SHA-256(seed, episode id): what everything that draws in the episode starts
// from.
std::uint64_t draw_seed(int seed, const Sha256& episode_id);

store::TraceHeader make_trace_header(const plan::Plan& plan, const EpisodeJob& job,
                                     const std::string& policy, const std::string& fingerprint);

// Runs the full horizon (`steps` of them if not negative). What goes wrong with the world, the
// picture or the policy, exceptions included, makes the row invalid; a Failure is only what the
// trace or the sink could not write. The row's `trace` is left empty.
Result<store::ResultRow> run_episode(TaskStage& stage, const plan::Plan& plan,
                                     const EpisodeJob& job, const std::string& policy_name,
                                     policy::Policy& policy, store::TraceWriter& trace,
                                     show::FrameSink* frames = nullptr, int steps = -1);

}  // namespace probe::run
