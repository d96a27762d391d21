#include "runtime/api/worlds.h"

#include <algorithm>
#include <exception>
#include <limits>
#include <utility>

#include "runtime/api/calls.h"
#include "runtime/stage/robot_of.h"

namespace probe::api {
namespace {

constexpr std::size_t kTool = 7;

std::string world_place(std::size_t world) { return "world " + std::to_string(world); }

Failure in_world(std::size_t world, const Failure& failure) {
  return {failure.code, failure.message,
          world_place(world) + (failure.where.empty() ? "" : ", " + failure.where)};
}

}  // namespace

Worlds::Worlds(std::shared_ptr<const SharedPlan> plan, std::vector<std::uint32_t> tasks,
               const WorldsOptions& options)
    : plan_(std::move(plan)),
      tasks_(std::move(tasks)),
      options_(options),
      worlds_(options.worlds),
      over_(options.worlds),
      terminated_(options.worlds),
      truncated_(options.worlds),
      begun_(options.worlds),
      ended_(options.worlds),
      faults_(options.worlds),
      crew_(options.threads) {}

Result<std::unique_ptr<Worlds>> Worlds::create(std::shared_ptr<const SharedPlan> plan,
                                               std::vector<std::uint32_t> tasks,
                                               const WorldsOptions& options) {
  std::ranges::sort(tasks);
  tasks.erase(std::unique(tasks.begin(), tasks.end()), tasks.end());
  if (tasks.empty()) return usage("worlds have no task to begin");
  auto made = std::unique_ptr<Worlds>(new Worlds(std::move(plan), std::move(tasks), options));
  PROBE_TRY(made->look_alike());
  PROBE_ASSIGN(made->assets_, made->plan_->assets(made->tasks_));
  PROBE_TRY(made->act_alike());
  made->now_ = made->room();
  if (options.autoreset == VLAPROBE_SAME_STEP) made->final_ = made->room();
  return made;
}

// One array holds what all worlds show, whichever task they are in.
Status Worlds::look_alike() {
  const plan::Plan& plan = plan_->plan();
  for (const std::uint32_t index : tasks_) {
    const plan::TaskRecord& task = plan.tasks()[index];
    const auto cameras = cameras_of(plan, task, options_.stage.image);
    const plan::RobotRecord& robot = plan.robots()[plan.scenes()[task.scene].robot];
    const std::size_t joints = plan.drives(robot).size();
    if (index == tasks_.front()) {
      cameras_ = cameras;
      joints_ = joints;
    }
    const bool differ = !std::ranges::equal(cameras, cameras_);
    if (differ || joints != joints_) {
      return usage(
          "tasks `" + plan_->name(tasks_.front()) + "` and `" + plan_->name(index) +
          "` do not fit one batch: " +
          (differ ? "their cameras have other names or sizes" : "their robots have other joints"));
    }
    std::vector<std::size_t>& columns = columns_.emplace_back();
    for (const plan::MetricRecord& metric : plan.metrics(task)) {
      const std::string name(plan.text(metric.name));
      const auto known = std::ranges::find(metrics_, name, &Metric::name);
      columns.push_back(static_cast<std::size_t>(known - metrics_.begin()));
      if (known != metrics_.end()) continue;
      metrics_.push_back(
          {name, metric.type == static_cast<std::uint32_t>(plan::MetricType::kBool)});
    }
  }
  return {};
}

// One array holds what all worlds are told.
Status Worlds::act_alike() {
  const plan::Plan& plan = plan_->plan();
  for (const std::uint32_t index : tasks_) {
    const plan::RobotRecord& record = plan.robots()[plan.scenes()[plan.tasks()[index].scene].robot];
    PROBE_ASSIGN(const robot::Robot robot,
                 stage::robot_of(plan, record, *assets_->robot(record.urdf)));
    ActionBounds actions(robot);
    if (!actions_) actions_ = std::move(actions);
    if (robot::action_space_of(robot) == actions_->space) continue;
    return usage("tasks `" + plan_->name(tasks_.front()) + "` and `" + plan_->name(index) +
                 "` do not fit one batch: their robots take other actions");
  }
  return {};
}

Columns Worlds::room() const {
  const std::size_t n = options_.worlds;
  Columns room;
  for (const Camera& camera : cameras_) {
    const auto pixels = static_cast<std::size_t>(camera.width * camera.height);
    room.rgb.emplace_back(options_.stage.pictures ? n * pixels * 3 : 0);
  }
  room.tool.resize(n * kTool);
  room.openness.resize(n);
  room.joints.resize(n * joints_);
  room.metrics.resize(n * metrics_.size());
  room.steps.resize(n);
  room.tasks.resize(n);
  room.episodes.resize(n);
  room.success.resize(n);
  room.decided.resize(n);
  return room;
}

Status Worlds::check_start(const vlaprobe_start& start) const {
  const auto task = static_cast<std::uint32_t>(start.task);
  if (start.task < 0 || !std::ranges::binary_search(tasks_, task))
    return usage("task " + std::to_string(start.task) + " is none of this batch");
  return plan_->check_episode(task, start.episode);
}

Status Worlds::begin(std::size_t world, const vlaprobe_start& start) {
  std::unique_ptr<World>& own = worlds_[world];
  const auto task = static_cast<std::uint32_t>(start.task);
  over_[world] = 0;
  if (!own || own->task() != task) {
    own.reset();  // frees the old before the new is made
    PROBE_ASSIGN(own, World::create(plan_, task, assets_, options_.stage));
  }
  PROBE_TRY(own->reset(start.episode));
  begun_[world] = 1;
  return show(world, now_);
}

Status Worlds::show(std::size_t world, Columns& out) {
  World& own = *worlds_[world];
  if (options_.stage.pictures) {
    if (auto seen = own.observe(); !seen) return seen.failure();
    const auto frames = own.stage().frames();
    for (std::size_t camera = 0; camera < frames.size(); ++camera) {
      const auto rgb = frames[camera].frame.rgb;
      std::ranges::copy(rgb,
                        out.rgb[camera].begin() + static_cast<std::ptrdiff_t>(world * rgb.size()));
    }
  }
  const auto row = [world](std::vector<double>& column, std::size_t width) {
    return column.begin() + static_cast<std::ptrdiff_t>(world * width);
  };
  const policy::Proprioception& robot = own.proprioception();
  double tool[kTool];
  own.write_tool(tool);
  std::ranges::copy(tool, row(out.tool, kTool));
  out.openness[world] = robot.openness;
  std::ranges::copy(robot.joints, row(out.joints, joints_));
  const auto metrics = row(out.metrics, metrics_.size());
  std::fill_n(metrics, metrics_.size(), std::numeric_limits<double>::quiet_NaN());
  const auto place = std::ranges::lower_bound(tasks_, own.task()) - tasks_.begin();
  const std::vector<std::size_t>& columns = columns_[static_cast<std::size_t>(place)];
  const auto values = own.stage().judge().values();
  for (std::size_t i = 0; i < values.size(); ++i)
    metrics[static_cast<std::ptrdiff_t>(columns[i])] = values[i];
  out.steps[world] = own.stage().steps();
  out.tasks[world] = static_cast<std::int32_t>(own.task());
  out.episodes[world] = own.episode();
  out.success[world] = own.success() ? 1 : 0;
  out.decided[world] = own.stage().judge().decided() ? 1 : 0;
  return {};
}

void Worlds::spoil(std::size_t world, const Failure& failure) {
  faults_[world] = to_text(in_world(world, failure));
  terminated_[world] = 0;
  truncated_[world] = over_[world] = 1;
  now_.success[world] = 0;
  now_.decided[world] = 0;
  std::fill_n(now_.metrics.begin() + static_cast<std::ptrdiff_t>(world * metrics_.size()),
              metrics_.size(), std::numeric_limits<double>::quiet_NaN());
}

Status Worlds::reset(std::span<const std::uint8_t> mask, std::span<const vlaprobe_start> starts) {
  const auto is_meant = [&](std::size_t world) { return mask.empty() || mask[world] != 0; };
  for (std::size_t i = 0; i < count(); ++i) {
    if (!is_meant(i)) continue;
    if (auto good = check_start(starts[i]); !good) return in_world(i, good.failure());
  }
  std::vector<std::optional<Failure>> failed(count());
  crew_.each(count(), [&](std::size_t world) {
    begun_[world] = ended_[world] = terminated_[world] = truncated_[world] = 0;
    faults_[world].reset();
    if (!is_meant(world)) return;
    try {
      if (auto begun = begin(world, starts[world]); !begun) failed[world] = begun.failure();
    } catch (const std::exception& exception) {
      failed[world] = Failure{Fault::kInternal, exception.what(), ""};
    }
    if (failed[world]) spoil(world, *failed[world]);
  });
  for (std::size_t i = 0; i < count(); ++i) {
    if (failed[i]) return in_world(i, *failed[i]);
  }
  return {};
}

Status Worlds::step(std::span<const double> actions, std::span<const vlaprobe_start> next) {
  std::vector<policy::Action> said(count());
  for (std::size_t i = 0; i < count(); ++i) {
    if (!worlds_[i]) return in_world(i, usage("no episode has begun: reset first"));
    const bool goes_on = over_[i] == 0;
    if (!goes_on && options_.autoreset == VLAPROBE_DISABLED)
      return in_world(i, usage("its episode is over: reset it"));
    if (!next.empty()) {
      if (auto good = check_start(next[i]); !good) return in_world(i, good.failure());
    }
    // Where the next episode begins nobody reads the action.
    if (!goes_on && options_.autoreset == VLAPROBE_NEXT_STEP) continue;
    const std::size_t size = actions_->space.size();
    const auto action = read_action(actions.subspan(i * size, size), size);
    if (!action) return in_world(i, action.failure());
    if (!goes_on) continue;
    if (auto good = worlds_[i]->check_step(); !good) return in_world(i, good.failure());
    said[i] = *action;
  }
  crew_.each(count(), [&](std::size_t world) {
    try {
      move(world, said[world], next.empty() ? nullptr : &next[world]);
    } catch (const std::exception& exception) {
      spoil(world, {Fault::kInternal, exception.what(), ""});
    }
  });
  return {};
}

void Worlds::move(std::size_t world, const policy::Action& action, const vlaprobe_start* next) {
  faults_[world].reset();
  begun_[world] = ended_[world] = terminated_[world] = truncated_[world] = 0;
  if (over_[world] != 0) {
    if (auto begun = begin(world, *next); !begun) spoil(world, begun.failure());
    return;
  }
  World& own = *worlds_[world];
  if (auto moved = own.step(action); !moved) return spoil(world, moved.failure());
  const bool terminated = own.terminated(), truncated = own.truncated();
  const bool ends = terminated || truncated;
  const bool goes_on_at_once = ends && options_.autoreset == VLAPROBE_SAME_STEP;
  if (auto shown = show(world, goes_on_at_once ? final_ : now_); !shown)
    return spoil(world, shown.failure());
  over_[world] = ended_[world] = ends ? 1 : 0;
  if (goes_on_at_once) {
    // What has ended has ended, whether or not the next one begins.
    if (auto begun = begin(world, *next); !begun) spoil(world, begun.failure());
  }
  terminated_[world] = terminated ? 1 : 0;
  truncated_[world] = truncated ? 1 : 0;
}

}  // namespace probe::api
