#include "runtime/api/plan.h"

#include <algorithm>
#include <cstring>

#include "compiler/diag/json.h"
#include "compiler/diag/text.h"
#include "runtime/api/calls.h"
#include "runtime/api/folders.h"
#include "runtime/base/asset_root.h"
#include "runtime/base/paths.h"
#include "runtime/base/sha256.h"
#include "runtime/base/spelling.h"
#include "runtime/compile/files.h"
#include "runtime/inspect/task_json.h"

namespace probe::api {

namespace {

std::string lines_of(const AssetRoot& root) {
  std::string lines;
  for (const std::string& folder : root.folders())
    lines += (lines.empty() ? "" : "\n") + absolute_path(folder);
  return lines;
}

}  // namespace

SharedPlan::SharedPlan(plan::Plan plan, AssetRoot assets)
    : plan_(std::move(plan)), root_(to_hex(plan_.root())), asset_root_(std::move(assets)),
      asset_folders_(lines_of(asset_root_)) {
  for (const plan::TaskRecord& task : plan_.tasks()) {
    names_.emplace_back(plan_.text(task.name));
    instructions_.emplace_back(plan_.text(task.prompt));
  }
  for (const plan::ObjectRecord& object : plan_.objects())
    objects_.emplace_back(plan_.text(object.name));
  for (const plan::SuiteRecord& suite : plan_.suites()) {
    suites_.emplace_back(plan_.text(suite.name));
    prefixes_.emplace_back(plan_.text(suite.prefix));
  }
}

Result<std::uint32_t> SharedPlan::find_task(std::string_view name) const {
  if (const auto found = plan_.find_task(name)) return *found;
  std::string message = "the plan has no task `" + std::string(name) + "`";
  const std::string near = did_you_mean(name, names_);
  message += near.empty() ? "; it has " + std::to_string(names_.size()) : near;
  return usage(std::move(message));
}

Result<std::uint32_t> SharedPlan::task(std::size_t number) const {
  if (number < names_.size()) return static_cast<std::uint32_t>(number);
  return usage("the plan has no task " + std::to_string(number) + "; it has " +
               std::to_string(names_.size()) + ", from 0 on");
}

Status SharedPlan::check_episode(std::uint32_t task, std::int32_t episode) const {
  const std::uint32_t count = plan_.tasks()[task].episodes.count;
  if (episode >= 0 && static_cast<std::uint32_t>(episode) < count) return {};
  return usage("no episode " + std::to_string(episode) + "; the task has " + std::to_string(count) +
                   ", from 0 on",
               task_place(*this, task));
}

Result<std::shared_ptr<const stage::SharedAssets>> SharedPlan::assets(
    std::span<const std::uint32_t> tasks) const {
  std::vector<std::uint32_t> wanted(tasks.begin(), tasks.end());
  std::ranges::sort(wanted);
  wanted.erase(std::unique(wanted.begin(), wanted.end()), wanted.end());
  // Two threads that want the same files read them once.
  const std::lock_guard lock(mutex_);
  for (const Loaded& loaded : loaded_) {
    if (std::ranges::includes(loaded.tasks, wanted)) return loaded.assets;
  }
  PROBE_ASSIGN(const AssetRoot root, find_asset_root(asset_root_));
  PROBE_ASSIGN(auto assets, stage::SharedAssets::load(plan_, root, wanted));
  loaded_.push_back({std::move(wanted), assets});
  return assets;
}

void SharedPlan::forget() const {
  const std::lock_guard lock(mutex_);
  loaded_.clear();
}

std::string task_place(const SharedPlan& plan, std::uint32_t task) {
  return "task `" + plan.name(task) + "`";
}

namespace {

vlaprobe_plan* handle_of(plan::Plan plan, AssetRoot assets) {
  return new vlaprobe_plan{std::make_shared<SharedPlan>(std::move(plan), std::move(assets))};
}

void write_hex(const std::array<std::uint8_t, 32>& id, char (&out)[65]) {
  const std::string hex = to_hex(Sha256{id});
  std::memcpy(out, hex.c_str(), sizeof out);
}

}  // namespace
}  // namespace probe::api

using namespace probe;
using api::call;

extern "C" {

int32_t vlaprobe_compile(const char* const* files, size_t count,
                         const vlaprobe_plan_options* options, vlaprobe_plan** plan,
                         vlaprobe_error* error) {
  std::string said, json;
  const int32_t code = call(error, [&]() -> Status {
    PROBE_TRY(api::needs({{plan, "plan"}}));
    PROBE_ASSIGN(const vlaprobe_plan_options given, api::read_options(options));
    if (count == 0) return api::usage("there is no file to compile");
    PROBE_ASSIGN(const std::vector<std::string> paths, api::read_texts(files, count, "files"));
    PROBE_ASSIGN(Compilation compiled,
                 compile::compile_files(paths, {.assets = api::folders_of(given.assets),
                                                .library = api::text_of(given.library),
                                                .suite = api::text_of(given.suite),
                                                .tasks = api::text_of(given.tasks)}));
    said = render_text(compiled.diagnostics, compiled.sources);
    json = render_json(compiled.diagnostics, compiled.sources);
    if (!compiled.ok) return api::usage(said);
    PROBE_ASSIGN(plan::Plan made, plan::Plan::from_bytes(std::move(compiled.plan)));
    AssetRoot assets = compile::root_for(made, compiled.asset_root);
    *plan = api::handle_of(std::move(made), std::move(assets));
    (*plan)->shared->only_used_suites =
        !(*plan)->shared->plan().suites().empty() && compiled.own_suites.empty();
    (*plan)->shared->warnings = {std::move(said), std::move(json)};
    json.clear();
    return {};
  });
  if (code == VLAPROBE_OK || json.empty()) return code;
  return api::fail(error, VLAPROBE_TEXT, said, json);
}

int32_t vlaprobe_plan_open(const char* path, const vlaprobe_plan_options* options,
                           vlaprobe_plan** plan, vlaprobe_error* error) {
  return call(error, [&]() -> Status {
    PROBE_TRY(api::needs({{path, "path"}, {plan, "plan"}}));
    PROBE_ASSIGN(const vlaprobe_plan_options given, api::read_options(options));
    PROBE_ASSIGN(plan::Plan opened, plan::Plan::open(path));
    AssetRoot assets = compile::root_for_file(opened, path, api::folders_of(given.assets));
    *plan = api::handle_of(std::move(opened), std::move(assets));
    return {};
  });
}

int32_t vlaprobe_plan_from_bytes(const void* bytes, size_t size,
                                 const vlaprobe_plan_options* options, vlaprobe_plan** plan,
                                 vlaprobe_error* error) {
  return call(error, [&]() -> Status {
    PROBE_TRY(api::needs({{bytes, "bytes"}, {plan, "plan"}}));
    PROBE_ASSIGN(const vlaprobe_plan_options given, api::read_options(options));
    const auto* first = static_cast<const std::byte*>(bytes);
    PROBE_ASSIGN(plan::Plan read, plan::Plan::from_bytes({first, first + size}));
    *plan = api::handle_of(std::move(read), api::folders_of(given.assets));
    return {};
  });
}

void vlaprobe_plan_release(vlaprobe_plan* plan) { delete plan; }

const char* vlaprobe_plan_root(const vlaprobe_plan* plan) {
  return plan == nullptr ? nullptr : plan->shared->root().c_str();
}

const char* vlaprobe_plan_assets(const vlaprobe_plan* plan) {
  return plan == nullptr ? nullptr : plan->shared->asset_folders().c_str();
}

const void* vlaprobe_plan_bytes(const vlaprobe_plan* plan, size_t* size) {
  if (size != nullptr) *size = 0;
  if (plan == nullptr) return nullptr;
  const auto bytes = plan->shared->plan().bytes();
  if (size != nullptr) *size = bytes.size();
  return bytes.data();
}

const char* vlaprobe_plan_warnings(const vlaprobe_plan* plan) {
  return plan == nullptr ? nullptr : plan->shared->warnings.text.c_str();
}

const char* vlaprobe_plan_diagnostics(const vlaprobe_plan* plan) {
  return plan == nullptr ? nullptr : plan->shared->warnings.json.c_str();
}

size_t vlaprobe_plan_task_count(const vlaprobe_plan* plan) {
  return plan == nullptr ? 0 : plan->shared->plan().tasks().size();
}

int32_t vlaprobe_plan_task(const vlaprobe_plan* plan, size_t task, vlaprobe_task* out,
                           vlaprobe_error* error) {
  return call(error, [&]() -> Status {
    PROBE_TRY(api::needs({{plan, "plan"}, {out, "out"}}));
    const api::SharedPlan& shared = *plan->shared;
    PROBE_ASSIGN(const std::uint32_t index, shared.task(task));
    const plan::TaskRecord& record = shared.plan().tasks()[index];
    const plan::RobotRecord& robot =
        shared.plan().robots()[shared.plan().scenes()[record.scene].robot];
    *out = {};
    out->name = shared.name(index).c_str();
    out->instruction = shared.instruction(index).c_str();
    out->baseline = record.baseline == plan::kNone ? -1 : static_cast<int64_t>(record.baseline);
    out->episodes = static_cast<int32_t>(record.episodes.count);
    out->horizon = static_cast<int32_t>(record.horizon);
    out->control_hz = robot.control_hz;
    out->cameras = static_cast<int32_t>(shared.plan().views(record).size());
    out->joints = static_cast<int32_t>(shared.plan().drives(robot).size());
    return {};
  });
}

int32_t vlaprobe_plan_find_task(const vlaprobe_plan* plan, const char* name, size_t* task,
                                vlaprobe_error* error) {
  return call(error, [&]() -> Status {
    PROBE_TRY(api::needs({{plan, "plan"}, {name, "name"}, {task, "task"}}));
    PROBE_ASSIGN(*task, plan->shared->find_task(name));
    return {};
  });
}

int32_t vlaprobe_plan_describe(const vlaprobe_plan* plan, size_t task, char** json,
                               vlaprobe_error* error) {
  return call(error, [&]() -> Status {
    PROBE_TRY(api::needs({{plan, "plan"}, {json, "json"}}));
    PROBE_ASSIGN(const std::uint32_t index, plan->shared->task(task));
    return api::give_text(inspect::describe(plan->shared->plan(), index).dump(), json);
  });
}

int32_t vlaprobe_plan_list(const vlaprobe_plan* plan, char** json, vlaprobe_error* error) {
  return call(error, [&]() -> Status {
    PROBE_TRY(api::needs({{plan, "plan"}, {json, "json"}}));
    const plan::Plan& whole = plan->shared->plan();
    return api::give_text(inspect::list(whole, inspect::all_tasks(whole)).dump(), json);
  });
}

size_t vlaprobe_plan_suite_count(const vlaprobe_plan* plan) {
  return plan == nullptr ? 0 : plan->shared->plan().suites().size();
}

int32_t vlaprobe_plan_suite(const vlaprobe_plan* plan, size_t suite, vlaprobe_suite* out,
                            vlaprobe_error* error) {
  return call(error, [&]() -> Status {
    PROBE_TRY(api::needs({{plan, "plan"}, {out, "out"}}));
    const plan::Plan& whole = plan->shared->plan();
    if (suite >= whole.suites().size()) {
      return api::usage("the plan has no suite " + std::to_string(suite) + "; it has " +
                        std::to_string(whole.suites().size()) + ", from 0 on");
    }
    const plan::SuiteRecord& record = whole.suites()[suite];
    const auto members = whole.members(record);
    const auto seeds = whole.seeds(record);
    out->name = plan->shared->suite_name(suite).c_str();
    out->prefix = plan->shared->suite_prefix(suite).c_str();
    out->tasks = members.data();
    out->task_count = members.size();
    out->seeds = seeds.data();
    out->seed_count = seeds.size();
    return {};
  });
}

int32_t vlaprobe_plan_episode(const vlaprobe_plan* plan, size_t task, int32_t episode,
                              vlaprobe_episode* out, vlaprobe_error* error) {
  return call(error, [&]() -> Status {
    PROBE_TRY(api::needs({{plan, "plan"}, {out, "out"}}));
    const api::SharedPlan& shared = *plan->shared;
    PROBE_ASSIGN(const std::uint32_t index, shared.task(task));
    PROBE_TRY(shared.check_episode(index, episode));
    const plan::EpisodeRecord& record =
        shared.plan().episodes(shared.plan().tasks()[index])[static_cast<std::size_t>(episode)];
    api::write_hex(record.episode_id, out->episode_id);
    api::write_hex(record.start_id, out->start_id);
    out->placements = static_cast<int32_t>(record.placements.count);
    return {};
  });
}

int32_t vlaprobe_plan_placement(const vlaprobe_plan* plan, size_t task, int32_t episode,
                                int32_t placement, vlaprobe_placement* out, vlaprobe_error* error) {
  return call(error, [&]() -> Status {
    PROBE_TRY(api::needs({{plan, "plan"}, {out, "out"}}));
    const api::SharedPlan& shared = *plan->shared;
    PROBE_ASSIGN(const std::uint32_t index, shared.task(task));
    PROBE_TRY(shared.check_episode(index, episode));
    const plan::Plan& whole = shared.plan();
    const auto placements =
        whole.placements(whole.episodes(whole.tasks()[index])[static_cast<std::size_t>(episode)]);
    if (placement < 0 || static_cast<std::size_t>(placement) >= placements.size()) {
      return api::usage("no placement " + std::to_string(placement) + "; the start has " +
                            std::to_string(placements.size()) + ", from 0 on",
                        api::task_place(shared, index));
    }
    const plan::PlacementRecord& record = placements[static_cast<std::size_t>(placement)];
    out->object = shared.object_name(record.object).c_str();
    std::ranges::copy(record.position, out->position);
    std::ranges::copy(record.rotation, out->rotation);
    return {};
  });
}

int32_t vlaprobe_plan_load(vlaprobe_plan* plan, const size_t* tasks, size_t count,
                           vlaprobe_error* error) {
  return call(error, [&]() -> Status {
    PROBE_TRY(api::needs({{plan, "plan"}}));
    if (count > 0) PROBE_TRY(api::needs({{tasks, "tasks"}}));
    std::vector<std::uint32_t> chosen;
    for (std::size_t i = 0; i < count; ++i) {
      PROBE_ASSIGN(const std::uint32_t task, plan->shared->task(tasks[i]));
      chosen.push_back(task);
    }
    if (auto loaded = plan->shared->assets(chosen); !loaded) return loaded.failure();
    return {};
  });
}

void vlaprobe_plan_forget(vlaprobe_plan* plan) {
  if (plan != nullptr) plan->shared->forget();
}
}
