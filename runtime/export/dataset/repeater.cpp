#include "runtime/export/dataset/repeater.h"

#include <string>

#include "runtime/run/episode.h"
#include "runtime/store/episode_key.h"

namespace probe::dataset {
namespace {

Failure differs(const store::Trace& trace, std::size_t step, const std::string& what) {
  return {Fault::kTrace,
          "step " + std::to_string(step) + ": " + what +
              " on this machine or build (`vlaprobe replay --verify` says what is otherwise)",
          store::to_text(store::key_of(trace.header))};
}

Failure named(const store::Trace& trace, std::size_t step, Failure failure) {
  failure.message = "step " + std::to_string(step) + ": " + to_text(failure);
  failure.where = store::to_text(store::key_of(trace.header));
  return failure;
}

}  // namespace

Status Repeater::repeat(const store::Trace& trace, const See& see) {
  const auto task = plan_.find_task(trace.header.task);
  if (!task || !trace.start)
    return Failure{Fault::kTrace, "is no whole episode of the run's plan",
                   store::to_text(store::key_of(trace.header))};
  if (!stage_ || stage_->task() != *task) {
    stage_.reset();  // frees it before the new one is made
    PROBE_ASSIGN(stage_, stage::Stage::create(plan_, *task, assets_));
  }
  if (auto reset = stage_->reset(static_cast<std::uint32_t>(trace.header.episode)); !reset)
    return named(trace, 0, reset.failure());
  if (stage_->state_hash() != trace.start->state_hash)
    return differs(trace, 0, "things come to rest otherwise than they did");
  for (std::size_t i = 0; i < trace.steps.size(); ++i) {
    const store::TraceStep& step = trace.steps[i];
    const auto observation = stage_->observe();
    if (!observation) return named(trace, i, observation.failure());
    if (run::picture_hash(stage_->frames()) != step.image_hash)
      return differs(trace, i, "the picture is not the one that the policy saw");
    PROBE_TRY(see(stage_->frames(), *observation, i));
    if (auto stepped = stage_->step(step.action); !stepped)
      return named(trace, i, stepped.failure());
    if (stage_->state_hash() != step.state_hash)
      return differs(trace, i, "its action leads elsewhere than it did");
  }
  return {};
}

}  // namespace probe::dataset
