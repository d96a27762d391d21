// A task made real: its world, its cameras and its judge, stepped from a start to the verdicts.
// Runs, replays, previews and the doctor stand on it. Knows nothing of policies' insides, of files
// that last, or of what happens between episodes. One stage is used by one thread at a time; stages
// share the plan and the assets.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/base/sha256.h"
#include "runtime/plan/plan.h"
#include "runtime/policy/policy.h"
#include "runtime/stage/assets.h"
#include "runtime/stage/episode_world.h"
#include "runtime/stage/scene_view.h"
#include "runtime/stage/stage_state.h"
#include "runtime/vm/judge.h"
#include "runtime/vm/told.h"

namespace probe::stage {

struct StageOptions {
  ImageSize image{};     // of every camera; zero: each camera's own
  bool pictures = true;  // false: observe() has no pictures, and nothing of them is set up
};

class Stage {
 public:
  // `assets` were loaded for this task; the plan must live as long as the stage. Fails with the
  // faults of what it is made of (kPlan, kAsset, kUrdf, kWorld, kRender).
  static Result<std::unique_ptr<Stage>> create(const plan::Plan& plan, std::uint32_t task,
                                               std::shared_ptr<const SharedAssets> assets,
                                               const StageOptions& options = {});

  // Begins an episode: the objects of the task's start `index` are dropped and settle with the arm
  // out of the way, then the judge begins. Failures of the judge have kJudge.
  Status reset(std::uint32_t index);

  // What a policy sees now: a picture of each camera, proprioception, the privileged view. What it
  // points to lives until the next call of observe(), step(), reset() or restore().
  Result<policy::Observation> observe();

  // One control step: action to joint targets, substeps, measurement, verdicts. After a failure
  // (kPolicy for an action that is none, kJudge, kWorld) only reset() and restore() may be
  // called.
  Status step(const policy::Action& action);

  // The episode as it is now, and back to it: what follows is the same bit for bit, in this stage
  // or in another of the same plan, task and fixtures, also in another process
  // (StageState::to_bytes). restore() fails (kWorld or kJudge) on a state of another task.
  StageState save() const;
  Status restore(const StageState& state);

  // The episode is over: what ends it holds, the horizon is reached, or no verdict can change any
  // more, whatever happens. Nothing keeps one from stepping on.
  bool done() const;

  // What a policy is told at the beginning of an episode, but for what the run draws (its seeds).
  policy::EpisodeStart introduction() const;

  const robot::Robot& robot() const { return world_->robot(); }
  // What step() takes.
  const robot::ActionSpace& action_space() const { return world_->action_space(); }

  // The pictures of the last observe(), with depth and segmentation.
  std::span<const CameraFrame> frames() const { return frames_; }

  // Since reset(), in control steps.
  int steps() const { return world_->steps(); }
  // What the judge reads, after reset() and after each step().
  const vm::StepSample& sample() const { return world_->sample(); }
  std::span<const vm::BodyStart> body_starts() const { return world_->starts(); }
  const vm::Judge& judge() const { return judge_; }
  // Which sentence of the instruction the next observation says.
  const vm::Told& told() const { return told_; }
  const policy::Privileged& privileged() const { return world_->privileged(); }
  // What observe() says of the robot, without the pictures.
  policy::Proprioception proprioception() const { return world_->proprioception(); }
  // The robot's joints in drive order, then those of fixtures: rad and m, rad/s and m/s.
  std::span<const double> q() const { return world_->q(); }
  std::span<const double> u() const { return world_->u(); }
  // What traces call the joints of q() and the bodies of sample(); a fixture's are "cabinet.top".
  std::vector<std::string> joint_names() const { return world_->joint_names(); }
  const std::vector<std::string>& body_names() const { return world_->bodies().names; }
  // Model poses of the objects in world, in the order of the task's bodies.
  std::span<const Pose> objects() const { return world_->objects(); }
  Sha256 state_hash() const { return world_->state_hash(); }

  std::uint32_t task() const { return task_; }
  // Null in a stage without pictures.
  SceneView* view() { return view_.get(); }

 private:
  Stage(const plan::Plan& plan, std::uint32_t task)
      : plan_(plan), task_(task), judge_(plan, task), told_(plan, task) {}

  const plan::Plan& plan_;
  std::uint32_t task_;
  std::uint32_t start_ = 0;
  std::unique_ptr<EpisodeWorld> world_;
  std::unique_ptr<SceneView> view_;
  vm::Judge judge_;
  vm::Told told_;
  std::span<const CameraFrame> frames_;
  std::vector<policy::CameraImage> images_;  // of the last observation

  // Where things were in the last steps, where a camera may show them late.
  void remember();
  const PastPlaces& past(int step) const;
  std::deque<PastPlaces> past_;
};

}  // namespace probe::stage
