// The order of an episode: settle, look, act, measure, judge.
#include "runtime/stage/stage.h"

#include <algorithm>
#include <string>
#include <utility>

namespace probe::stage {

Result<std::unique_ptr<Stage>> Stage::create(const plan::Plan& plan, std::uint32_t task,
                                             std::shared_ptr<const SharedAssets> assets,
                                             const StageOptions& options) {
  auto stage = std::unique_ptr<Stage>(new Stage(plan, task));
  PROBE_ASSIGN(stage->world_, EpisodeWorld::create(plan, task, assets));
  if (options.pictures) {
    PROBE_ASSIGN(stage->view_, SceneView::create(plan, task, std::move(assets), options.image));
  }
  return stage;
}

Status Stage::reset(std::uint32_t index) {
  frames_ = {};
  start_ = index;
  PROBE_TRY(world_->reset(index));
  past_.clear();
  remember();
  PROBE_TRY(told_.begin(world_->starts()));
  return judge_.begin(world_->starts());
}

Result<policy::Observation> Stage::observe() {
  const plan::TaskRecord& task = plan_.tasks()[task_];
  policy::Observation seen;
  images_.clear();
  if (view_) {
    const plan::EpisodeRecord& episode = plan_.episodes(task)[start_];
    const auto at = [this](int step) -> SceneView::Placed {
      if (step == steps()) return {world_->q(), world_->objects()};
      const PastPlaces& then = past(step);
      return {then.q, then.objects};
    };
    PROBE_ASSIGN(frames_, view_->render_seen({Sha256{episode.start_id}, steps()}, at));
    for (const CameraFrame& frame : frames_) {
      images_.push_back({frame.camera, {frame.frame.width, frame.frame.height, frame.frame.rgb}});
    }
    seen.image = images_.front().image;
  }
  seen.cameras = images_;
  seen.prompt = told_.text();
  seen.proprioception = world_->proprioception();
  seen.privileged = &world_->privileged();
  seen.step = world_->steps();
  seen.horizon = static_cast<int>(task.horizon);
  return seen;
}

Status Stage::step(const policy::Action& action) {
  PROBE_TRY(world_->act(action));
  remember();
  PROBE_TRY(told_.step(world_->sample()));
  return judge_.step(world_->sample());
}

void Stage::remember() {
  if (!view_ || !view_->drops()) return;
  const auto q = world_->q();
  const auto objects = world_->objects();
  past_.push_back({steps(), {q.begin(), q.end()}, {objects.begin(), objects.end()}});
  // The first, for a camera that shows nothing else, and as many as another may be late.
  if (past_.size() > 1 + static_cast<std::size_t>(Sensor::kLongestGap))
    past_.erase(past_.begin() + 1);
}

// The state of a stage without pictures has none: then it is shown as it is.
const PastPlaces& Stage::past(int step) const {
  const auto then = std::ranges::find(past_, step, &PastPlaces::step);
  return then == past_.end() ? past_.back() : *then;
}

bool Stage::done() const {
  return judge_.ended() || judge_.decided() ||
         steps() >= static_cast<int>(plan_.tasks()[task_].horizon);
}

StageState Stage::save() const {
  const plan::EpisodeRecord& episode = plan_.episodes(plan_.tasks()[task_])[start_];
  return {start_,
          Sha256{episode.episode_id},
          world_->save(),
          judge_.save(),
          told_.count() > 1 ? std::optional(told_.save()) : std::nullopt,
          {past_.begin(), past_.end()}};
}

Status Stage::restore(const StageState& state) {
  frames_ = {};
  const auto episodes = plan_.episodes(plan_.tasks()[task_]);
  if (state.start >= episodes.size() ||
      state.episode_id != Sha256{episodes[state.start].episode_id}) {
    return Failure{Fault::kWorld, "the saved state is of another plan, task or start",
                   "task `" + std::string(plan_.text(plan_.tasks()[task_].name)) + "`"};
  }
  PROBE_TRY(world_->begin_view(state.start));
  PROBE_TRY(world_->restore(state.world));
  start_ = state.start;
  for (const PastPlaces& places : state.past) {
    if (places.q.size() == world_->q().size() && places.objects.size() == world_->objects().size())
      continue;
    return Failure{Fault::kWorld, "the saved state shows other things than are in this task",
                   "task `" + std::string(plan_.text(plan_.tasks()[task_].name)) + "`"};
  }
  past_.assign(state.past.begin(), state.past.end());
  if (past_.empty()) remember();
  PROBE_TRY(told_.restore(world_->starts(), state.told.value_or(vm::ToldState{})));
  return judge_.restore(world_->starts(), state.judge);
}

policy::EpisodeStart Stage::introduction() const {
  const plan::TaskRecord& task = plan_.tasks()[task_];
  policy::EpisodeStart start;
  start.task = plan_.text(task.name);
  start.prompt = told_.text();
  start.index = static_cast<int>(start_);
  start.horizon = static_cast<int>(task.horizon);
  start.delay = static_cast<int>(task.delay);
  start.control_hz = plan_.robots()[plan_.scenes()[task.scene].robot].control_hz;
  start.robot = &world_->robot();
  return start;
}

}  // namespace probe::stage
