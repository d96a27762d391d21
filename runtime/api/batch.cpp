// A batch of worlds behind its handle.
#include <algorithm>
#include <cstring>
#include <thread>

#include "runtime/api/arrays.h"
#include "runtime/api/calls.h"
#include "runtime/api/handles.h"

using namespace probe;
using api::call;
using api::Use;

namespace {

constexpr const char* kBatch = "batch";
constexpr std::int32_t kMostWorlds = 4096, kMostThreads = 1024;

vlaprobe_batch* own(const vlaprobe_batch* batch) { return const_cast<vlaprobe_batch*>(batch); }

Result<api::WorldsOptions> read(const vlaprobe_batch_options& given) {
  if (given.worlds < 1 || given.worlds > kMostWorlds) {
    return api::usage("a batch has 1 to " + std::to_string(kMostWorlds) + " worlds, found " +
                      std::to_string(given.worlds));
  }
  if (given.threads < 0 || given.threads > kMostThreads) {
    return api::usage("a batch has 1 to " + std::to_string(kMostThreads) +
                      " threads, or 0 for one a core; found " + std::to_string(given.threads));
  }
  if (given.autoreset < VLAPROBE_NEXT_STEP || given.autoreset > VLAPROBE_DISABLED)
    return api::usage("there is no autoreset " + std::to_string(given.autoreset));
  PROBE_TRY(api::check_picture_size(given.width, given.height));
  const int all = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  return api::WorldsOptions{
      .worlds = static_cast<std::size_t>(given.worlds),
      .threads = std::min(given.threads == 0 ? all : given.threads, given.worlds),
      .stage = {{given.width, given.height}, given.no_pictures == 0},
      .autoreset = static_cast<vlaprobe_autoreset>(given.autoreset)};
}

Status give_column(const api::Worlds& worlds, const api::Columns& columns, std::int32_t field,
                   std::size_t camera, vlaprobe_array* out) {
  const std::size_t n = worlds.count();
  const auto give = [&](const auto& column, std::initializer_list<std::size_t> shape) -> Status {
    *out = api::array_of(std::span(column), shape);
    return {};
  };
  switch (field) {
    case VLAPROBE_FIELD_RGB: {
      if (!worlds.options().stage.pictures)
        return api::usage("the batch was made without pictures");
      if (camera >= columns.rgb.size()) {
        return api::usage("the batch has no camera " + std::to_string(camera) + "; it has " +
                          std::to_string(columns.rgb.size()) + ", from 0 on");
      }
      const api::Camera& seen = worlds.cameras()[camera];
      return give(columns.rgb[camera], {n, static_cast<std::size_t>(seen.height),
                                        static_cast<std::size_t>(seen.width), 3});
    }
    case VLAPROBE_FIELD_TOOL:
      return give(columns.tool, {n, 7});
    case VLAPROBE_FIELD_OPENNESS:
      return give(columns.openness, {n});
    case VLAPROBE_FIELD_JOINTS:
      return give(columns.joints, {n, worlds.joints()});
    case VLAPROBE_FIELD_METRICS:
      return give(columns.metrics, {n, worlds.metrics().size()});
    case VLAPROBE_FIELD_STEPS:
      return give(columns.steps, {n});
    case VLAPROBE_FIELD_TASK:
      return give(columns.tasks, {n});
    case VLAPROBE_FIELD_EPISODE:
      return give(columns.episodes, {n});
    case VLAPROBE_FIELD_SUCCESS:
      return give(columns.success, {n});
    case VLAPROBE_FIELD_DECIDED:
      return give(columns.decided, {n});
    case VLAPROBE_FIELD_TERMINATED:
      return give(worlds.terminated(), {n});
    case VLAPROBE_FIELD_TRUNCATED:
      return give(worlds.truncated(), {n});
    case VLAPROBE_FIELD_BEGUN:
      return give(worlds.begun(), {n});
    case VLAPROBE_FIELD_ENDED:
      return give(worlds.ended(), {n});
    default:
      return api::usage("there is no field " + std::to_string(field));
  }
}

}  // namespace

extern "C" {

int32_t vlaprobe_batch_create(const vlaprobe_plan* plan, const size_t* tasks, size_t count,
                              const vlaprobe_batch_options* options, vlaprobe_batch** batch,
                              vlaprobe_error* error) {
  return call(error, [&]() -> Status {
    PROBE_TRY(
        api::needs({{plan, "plan"}, {tasks, "tasks"}, {options, "options"}, {batch, "batch"}}));
    PROBE_ASSIGN(const vlaprobe_batch_options given, api::read_options(options));
    PROBE_ASSIGN(const api::WorldsOptions read_options, read(given));
    std::vector<std::uint32_t> chosen;
    for (std::size_t i = 0; i < count; ++i) {
      PROBE_ASSIGN(const std::uint32_t task, plan->shared->task(tasks[i]));
      chosen.push_back(task);
    }
    auto made = std::make_unique<vlaprobe_batch>();
    PROBE_ASSIGN(made->worlds, api::Worlds::create(plan->shared, std::move(chosen), read_options));
    *batch = made.release();
    return {};
  });
}

void vlaprobe_batch_release(vlaprobe_batch* batch) {
  // A forked copy has none of the threads that would have to end.
  if (batch != nullptr && batch->lock.process == ::getpid()) delete batch;
}

int32_t vlaprobe_batch_reset(vlaprobe_batch* batch, const uint8_t* mask,
                             const vlaprobe_start* starts, vlaprobe_error* error) {
  return call(error, [&]() -> Status {
    PROBE_TRY(api::needs({{batch, "batch"}, {starts, "starts"}}));
    PROBE_ASSIGN(const Use use, Use::of(batch->lock, kBatch));
    const std::size_t n = batch->worlds->count();
    return batch->worlds->reset({mask, mask == nullptr ? 0 : n}, {starts, n});
  });
}

int32_t vlaprobe_batch_action_space(const vlaprobe_batch* batch, vlaprobe_action_space* out,
                                    vlaprobe_error* error) {
  return call(error, [&]() -> Status {
    PROBE_TRY(api::needs({{batch, "batch"}, {out, "out"}}));
    PROBE_ASSIGN(const Use use, Use::of(own(batch)->lock, kBatch));
    *out = batch->worlds->actions().told();
    return {};
  });
}

int32_t vlaprobe_batch_step(vlaprobe_batch* batch, const double* actions,
                            const vlaprobe_start* next, vlaprobe_error* error) {
  return call(error, [&]() -> Status {
    PROBE_TRY(api::needs({{batch, "batch"}, {actions, "actions"}}));
    PROBE_ASSIGN(const Use use, Use::of(batch->lock, kBatch));
    api::Worlds& worlds = *batch->worlds;
    if (next == nullptr && worlds.options().autoreset != VLAPROBE_DISABLED)
      return api::usage("a batch whose episodes begin by themselves is told their next starts");
    return worlds.step({actions, worlds.count() * worlds.actions().space.size()},
                       {next, next == nullptr ? 0 : worlds.count()});
  });
}

int32_t vlaprobe_batch_array(const vlaprobe_batch* batch, int32_t field, size_t camera,
                             vlaprobe_array* out, vlaprobe_error* error) {
  return call(error, [&]() -> Status {
    PROBE_TRY(api::needs({{batch, "batch"}, {out, "out"}}));
    PROBE_ASSIGN(const Use use, Use::of(own(batch)->lock, kBatch));
    return give_column(*batch->worlds, batch->worlds->now(), field, camera, out);
  });
}

int32_t vlaprobe_batch_final(const vlaprobe_batch* batch, int32_t field, size_t camera,
                             vlaprobe_array* out, vlaprobe_error* error) {
  return call(error, [&]() -> Status {
    PROBE_TRY(api::needs({{batch, "batch"}, {out, "out"}}));
    PROBE_ASSIGN(const Use use, Use::of(own(batch)->lock, kBatch));
    if (batch->worlds->options().autoreset != VLAPROBE_SAME_STEP)
      return api::usage("only a batch that begins anew in the same step has final arrays");
    return give_column(*batch->worlds, batch->worlds->final(), field, camera, out);
  });
}

const char* vlaprobe_batch_fault(const vlaprobe_batch* batch, size_t world) {
  if (batch == nullptr || world >= batch->worlds->count()) return nullptr;
  const std::string* fault = batch->worlds->fault(world);
  return fault == nullptr ? nullptr : fault->c_str();
}

const char* vlaprobe_batch_camera(const vlaprobe_batch* batch, size_t camera) {
  if (batch == nullptr) return nullptr;
  const auto& cameras = batch->worlds->cameras();
  return camera < cameras.size() ? cameras[camera].name.c_str() : nullptr;
}

const char* vlaprobe_batch_metric(const vlaprobe_batch* batch, size_t metric) {
  if (batch == nullptr) return nullptr;
  const auto& metrics = batch->worlds->metrics();
  return metric < metrics.size() ? metrics[metric].name.c_str() : nullptr;
}

int32_t vlaprobe_batch_metric_is_truth(const vlaprobe_batch* batch, size_t metric) {
  if (batch == nullptr) return 0;
  const auto& metrics = batch->worlds->metrics();
  return metric < metrics.size() && metrics[metric].is_truth;
}

const char* vlaprobe_batch_instruction(const vlaprobe_batch* batch, size_t world) {
  if (batch == nullptr || world >= batch->worlds->count()) return nullptr;
  const api::World* const one = batch->worlds->world(world);
  return one == nullptr ? nullptr : one->stage().told().text().c_str();
}

int32_t vlaprobe_batch_hash(const vlaprobe_batch* batch, size_t world, char hash[65],
                            vlaprobe_error* error) {
  return call(error, [&]() -> Status {
    PROBE_TRY(api::needs({{batch, "batch"}, {hash, "hash"}}));
    PROBE_ASSIGN(const Use use, Use::of(own(batch)->lock, kBatch));
    if (world >= batch->worlds->count() || batch->worlds->world(world) == nullptr)
      return api::usage("no episode has begun", "world " + std::to_string(world));
    PROBE_TRY(batch->worlds->world(world)->check_episode());
    const std::string hex = to_hex(batch->worlds->world(world)->stage().state_hash());
    std::memcpy(hash, hex.c_str(), hex.size() + 1);
    return {};
  });
}
}
