// A stage behind its handle.
#include <algorithm>
#include <cstring>
#include <utility>

#include "runtime/api/arrays.h"
#include "runtime/api/calls.h"
#include "runtime/api/handles.h"

using namespace probe;
using api::call;
using api::Use;

namespace {

constexpr const char* kStage = "stage";

// The questions change nothing that shows; what they keep for their answer is the handle's.
vlaprobe_stage* own(const vlaprobe_stage* stage) { return const_cast<vlaprobe_stage*>(stage); }

const char* name_at(const std::vector<std::string>& names, size_t index) {
  return index < names.size() ? names[index].c_str() : nullptr;
}

}  // namespace

extern "C" {

int32_t vlaprobe_stage_create(const vlaprobe_plan* plan, size_t task,
                              const vlaprobe_stage_options* options, vlaprobe_stage** stage,
                              vlaprobe_error* error) {
  return call(error, [&]() -> Status {
    PROBE_TRY(api::needs({{plan, "plan"}, {stage, "stage"}}));
    PROBE_ASSIGN(const vlaprobe_stage_options given, api::read_options(options));
    PROBE_TRY(api::check_picture_size(given.width, given.height));
    PROBE_ASSIGN(const std::uint32_t index, plan->shared->task(task));
    PROBE_ASSIGN(auto assets, plan->shared->assets({&index, 1}));
    auto made = std::make_unique<vlaprobe_stage>();
    made->has_pictures = given.no_pictures == 0;
    PROBE_ASSIGN(made->world,
                 api::World::create(plan->shared, index, std::move(assets),
                                    {{given.width, given.height}, made->has_pictures}));
    *stage = made.release();
    return {};
  });
}

void vlaprobe_stage_release(vlaprobe_stage* stage) {
  // Of a forked copy nothing is given back: threads and devices of the other process belong to it.
  if (stage != nullptr && stage->lock.process == ::getpid()) delete stage;
}

int32_t vlaprobe_stage_reset(vlaprobe_stage* stage, int32_t episode, vlaprobe_error* error) {
  return call(error, [&]() -> Status {
    PROBE_TRY(api::needs({{stage, "stage"}}));
    PROBE_ASSIGN(const Use use, Use::of(stage->lock, kStage));
    stage->is_observed = false;
    return stage->world->reset(episode);
  });
}

int32_t vlaprobe_stage_step(vlaprobe_stage* stage, const double* action, size_t size,
                            vlaprobe_error* error) {
  return call(error, [&]() -> Status {
    PROBE_TRY(api::needs({{stage, "stage"}, {action, "action"}}));
    PROBE_ASSIGN(const Use use, Use::of(stage->lock, kStage));
    PROBE_TRY(stage->world->check_step());
    PROBE_ASSIGN(const policy::Action numbers,
                 api::read_action({action, size}, stage->world->actions().space.size()));
    stage->is_observed = false;
    return stage->world->step(numbers);
  });
}

int32_t vlaprobe_stage_action_space(const vlaprobe_stage* stage, vlaprobe_action_space* out,
                                    vlaprobe_error* error) {
  return call(error, [&]() -> Status {
    PROBE_TRY(api::needs({{stage, "stage"}, {out, "out"}}));
    PROBE_ASSIGN(const Use use, Use::of(own(stage)->lock, kStage));
    *out = stage->world->actions().told();
    return {};
  });
}

int32_t vlaprobe_stage_state(const vlaprobe_stage* stage, vlaprobe_state* out,
                             vlaprobe_error* error) {
  return call(error, [&]() -> Status {
    PROBE_TRY(api::needs({{stage, "stage"}, {out, "out"}}));
    PROBE_ASSIGN(const Use use, Use::of(own(stage)->lock, kStage));
    api::World& world = *own(stage)->world;
    PROBE_TRY(world.check_episode());
    const policy::Proprioception& robot = world.proprioception();
    const auto metrics = world.stage().judge().values();
    const auto objects = world.objects();
    *out = {};
    out->episode = world.episode();
    out->steps = world.stage().steps();
    out->horizon = world.horizon();
    out->terminated = world.terminated() ? 1 : 0;
    out->truncated = world.truncated() ? 1 : 0;
    out->decided = world.stage().judge().decided() ? 1 : 0;
    out->success = world.success() ? 1 : 0;
    world.write_tool(out->tool);
    out->openness = robot.openness;
    out->joints = api::array_of(std::span<const double>(robot.joints), {robot.joints.size()});
    out->metrics = api::array_of(metrics, {metrics.size()});
    out->objects = api::array_of(objects, {objects.size() / 7, 7});
    return {};
  });
}

int32_t vlaprobe_stage_hash(const vlaprobe_stage* stage, char hash[65], vlaprobe_error* error) {
  return call(error, [&]() -> Status {
    PROBE_TRY(api::needs({{stage, "stage"}, {hash, "hash"}}));
    PROBE_ASSIGN(const Use use, Use::of(own(stage)->lock, kStage));
    PROBE_TRY(stage->world->check_episode());
    const std::string hex = to_hex(stage->world->stage().state_hash());
    std::memcpy(hash, hex.c_str(), hex.size() + 1);
    return {};
  });
}

int32_t vlaprobe_stage_observe(vlaprobe_stage* stage, vlaprobe_error* error) {
  return call(error, [&]() -> Status {
    PROBE_TRY(api::needs({{stage, "stage"}}));
    PROBE_ASSIGN(const Use use, Use::of(stage->lock, kStage));
    if (!stage->has_pictures) return api::usage("the stage was made without pictures");
    if (auto seen = stage->world->observe(); !seen) return seen.failure();
    stage->is_observed = true;
    return {};
  });
}

int32_t vlaprobe_stage_picture(const vlaprobe_stage* stage, size_t camera, int32_t kind,
                               vlaprobe_array* out, vlaprobe_error* error) {
  return call(error, [&]() -> Status {
    PROBE_TRY(api::needs({{stage, "stage"}, {out, "out"}}));
    PROBE_ASSIGN(const Use use, Use::of(own(stage)->lock, kStage));
    if (!stage->is_observed) return api::usage("nothing was drawn of what is now: observe first");
    const auto frames = stage->world->stage().frames();
    if (camera >= frames.size()) {
      return api::usage("the task has no camera " + std::to_string(camera) + "; it has " +
                        std::to_string(frames.size()) + ", from 0 on");
    }
    const render::FrameView& frame = frames[camera].frame;
    const auto height = static_cast<std::size_t>(frame.height);
    const auto width = static_cast<std::size_t>(frame.width);
    switch (kind) {
      case VLAPROBE_RGB:
        *out = api::array_of(frame.rgb, {height, width, 3});
        return {};
      case VLAPROBE_DEPTH:
        *out = api::array_of(frame.depth, {height, width});
        return {};
      case VLAPROBE_SEGMENTATION:
        *out = api::array_of(frame.segmentation, {height, width});
        return {};
      default:
        return api::usage("there is no kind of picture " + std::to_string(kind));
    }
  });
}

const char* vlaprobe_stage_camera(const vlaprobe_stage* stage, size_t camera) {
  if (stage == nullptr) return nullptr;
  const auto& cameras = stage->world->cameras();
  return camera < cameras.size() ? cameras[camera].name.c_str() : nullptr;
}

const char* vlaprobe_stage_metric(const vlaprobe_stage* stage, size_t metric) {
  if (stage == nullptr) return nullptr;
  const vm::Judge& judge = stage->world->stage().judge();
  if (metric >= judge.metric_count()) return nullptr;
  return judge.metric_name(static_cast<std::uint32_t>(metric)).c_str();
}

const char* vlaprobe_stage_instruction(const vlaprobe_stage* stage) {
  return stage == nullptr ? nullptr : stage->world->stage().told().text().c_str();
}

int32_t vlaprobe_stage_metric_is_truth(const vlaprobe_stage* stage, size_t metric) {
  if (stage == nullptr) return 0;
  const vm::Judge& judge = stage->world->stage().judge();
  return metric < judge.metric_count() &&
         judge.metric_type(static_cast<std::uint32_t>(metric)) == plan::MetricType::kBool;
}

const char* vlaprobe_stage_joint(const vlaprobe_stage* stage, size_t joint) {
  return stage == nullptr ? nullptr : name_at(stage->world->joint_names(), joint);
}

const char* vlaprobe_stage_object(const vlaprobe_stage* stage, size_t object) {
  if (stage == nullptr || object >= stage->world->object_count()) return nullptr;
  return name_at(stage->world->stage().body_names(), object);
}

const char* vlaprobe_stage_body(const vlaprobe_stage* stage, size_t body) {
  return stage == nullptr ? nullptr : name_at(stage->world->stage().body_names(), body);
}

int32_t vlaprobe_stage_picture_size(const vlaprobe_stage* stage, size_t camera, int32_t* height,
                                    int32_t* width, vlaprobe_error* error) {
  return call(error, [&]() -> Status {
    PROBE_TRY(api::needs({{stage, "stage"}, {height, "height"}, {width, "width"}}));
    const auto& cameras = stage->world->cameras();
    if (camera >= cameras.size()) {
      return api::usage("the task has no camera " + std::to_string(camera) + "; it has " +
                        std::to_string(cameras.size()) + ", from 0 on");
    }
    *height = cameras[camera].height;
    *width = cameras[camera].width;
    return {};
  });
}

int32_t vlaprobe_stage_save(vlaprobe_stage* stage, const void** bytes, size_t* size,
                            vlaprobe_error* error) {
  return call(error, [&]() -> Status {
    PROBE_TRY(api::needs({{stage, "stage"}, {bytes, "bytes"}, {size, "size"}}));
    PROBE_ASSIGN(const Use use, Use::of(stage->lock, kStage));
    PROBE_ASSIGN(stage->saved, stage->world->save());
    *bytes = stage->saved.data();
    *size = stage->saved.size();
    return {};
  });
}

int32_t vlaprobe_stage_restore(vlaprobe_stage* stage, const void* bytes, size_t size,
                               vlaprobe_error* error) {
  return call(error, [&]() -> Status {
    PROBE_TRY(api::needs({{stage, "stage"}, {bytes, "bytes"}}));
    PROBE_ASSIGN(const Use use, Use::of(stage->lock, kStage));
    stage->is_observed = false;
    return stage->world->restore({static_cast<const std::byte*>(bytes), size});
  });
}
}
