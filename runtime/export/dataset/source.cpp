#include "runtime/export/dataset/source.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include "runtime/base/glob.h"
#include "runtime/store/episode_key.h"
#include "runtime/store/folder_lock.h"
#include "runtime/store/not_attempted.h"
#include "runtime/store/run_plan.h"
#include "runtime/store/store.h"
#include "runtime/store/stored_trace.h"

namespace probe::dataset {
namespace {

// `pushed:SIGMA`, but of no size.
bool is_pushed(const store::RunIdentity& identity) {
  std::string_view policy = identity.policy;
  if (std::string_view(identity.policy_content).starts_with(store::kOwnPolicy)) {
    policy = identity.policy_content;
    policy.remove_prefix(store::kOwnPolicy.size());
  }
  constexpr std::string_view kPushed = "pushed:";
  return policy.starts_with(kPushed) && policy.find_first_of("123456789") != std::string_view::npos;
}

std::string counted(std::size_t count) {
  return std::to_string(count) + (count == 1 ? " episode" : " episodes");
}

// NAME, or NAME=VIEW,VIEW...
Result<CameraShape> chosen_camera(const std::string& option) {
  CameraShape camera;
  const std::size_t sign = option.find('=');
  camera.name = option.substr(0, sign);
  for (std::size_t at = sign; at != std::string::npos;) {
    const std::size_t end = option.find(',', at + 1);
    camera.views.push_back(option.substr(at + 1, end == std::string::npos ? end : end - at - 1));
    at = end;
  }
  const bool is_blank =
      camera.name.empty() || std::ranges::find(camera.views, "") != camera.views.end();
  if (is_blank || camera.name.find_first_of("/. ") != std::string::npos)
    return Failure{Fault::kUsage, "expected NAME or NAME=VIEW,VIEW, found `" + option + "`",
                   "--camera"};
  return camera;
}

Result<std::vector<CameraShape>> cameras_of(const plan::Plan& plan, const plan::TaskRecord& task,
                                            const DatasetOptions& options) {
  std::vector<CameraShape> all = dataset::cameras_of(plan, task), chosen;
  std::string known;
  for (CameraShape& shape : all) {
    if (options.width > 0) {
      shape.width = options.width;
      shape.height = options.height;
    }
    known += (known.empty() ? "`" : ", `") + shape.name + "`";
  }
  if (options.cameras.empty()) return all;
  const auto refused = [&](std::string_view what, std::string_view camera) {
    return Failure{
        Fault::kUsage,
        fmt::format("task `{}` {} `{}`, but {}", plan.text(task.name), what, camera, known),
        "--camera"};
  };
  for (const std::string& option : options.cameras) {
    PROBE_ASSIGN(CameraShape wanted, chosen_camera(option));
    const auto is_it = [&](const CameraShape& one) { return wanted.is(one.name); };
    const auto found = std::ranges::find_if(all, is_it);
    if (found == all.end()) return refused("has no camera", option);
    if (std::find_if(found + 1, all.end(), is_it) != all.end())
      return refused("has several of the cameras", option);
    wanted.width = found->width;
    wanted.height = found->height;
    const auto same = std::ranges::find(chosen, wanted.name, &CameraShape::name);
    if (same == chosen.end()) {
      chosen.push_back(std::move(wanted));
    } else if (*same != wanted) {
      return Failure{Fault::kUsage, "two cameras would be called `" + wanted.name + "`",
                     "--camera"};
    }
  }
  return chosen;
}

// In what two tasks differ that go into one dataset, or nothing.
std::string difference(const Shape& a, const Shape& b) {
  if (a.robot != b.robot)
    return fmt::format("one has robot `{}`, the other `{}`", a.robot, b.robot);
  if (a.joints != b.joints) return "their robots have other joints";
  if (a.control_hz != b.control_hz)
    return fmt::format("one has {} control steps a second, the other {}", a.control_hz,
                       b.control_hz);
  if (a.law != b.law || a.action_size != b.action_size) return "their actions are of other numbers";
  if (a.cameras == b.cameras) return "";
  const auto names = [](const Shape& shape) {
    std::string text;
    for (const CameraShape& camera : shape.cameras)
      text += fmt::format("{}`{}` {} x {}", text.empty() ? "" : ", ", camera.name, camera.width,
                          camera.height);
    return text;
  };
  return fmt::format(
      "one has cameras {}, the other {} (--camera chooses and --camera NAME=A,B calls "
      "A of one and B of the other NAME; --size gives one size)",
      names(a), names(b));
}

Result<Shape> shape_of_task(const plan::Plan& plan, const plan::TaskRecord& task,
                            const DatasetOptions& options) {
  const plan::RobotRecord& robot = plan.robots()[plan.scenes()[task.scene].robot];
  Shape shape;
  shape.robot = std::string(plan.text(robot.name));
  shape.control_hz = robot.control_hz;
  for (const plan::DriveRecord& drive : plan.drives(robot))
    shape.joints.emplace_back(plan.text(drive.joint));
  PROBE_ASSIGN(shape.cameras, cameras_of(plan, task, options));
  shape.fps = options.fps > 0 ? options.fps : static_cast<int>(std::lround(robot.control_hz));
  if (options.fps <= 0 && static_cast<double>(shape.fps) != robot.control_hz) {
    return Failure{Fault::kUsage,
                   fmt::format("task `{}` has {} control steps a second, and a dataset a whole "
                               "number of frames; --fps N names the one to write",
                               plan.text(task.name), robot.control_hz),
                   "--fps"};
  }
  if (std::abs(shape.fps - robot.control_hz) >= 1) {
    return Failure{Fault::kUsage,
                   fmt::format("task `{}` has {} control steps a second, and a frame is a step: {} "
                               "frames would take another time than the episode did",
                               plan.text(task.name), robot.control_hz, shape.fps),
                   "--fps"};
  }
  return shape;
}

// What actions are the traces say: which of the robot's joints are fingers no plan does.
void add_actions(const Source& source, const plan::TaskRecord& task, Shape* shape) {
  const auto control = static_cast<plan::Control>(
      source.plan.robots()[source.plan.scenes()[task.scene].robot].control);
  if (control != plan::Control::kJointDelta && control != plan::Control::kJointPosition) return;
  for (const store::ResultRow& row : source.rows) {
    if (row.task != source.plan.text(task.name)) continue;
    const auto trace = store::read_stored_trace(row);
    if (!trace || !trace->header.joint_actions) continue;
    shape->law = trace->header.joint_actions->law;
    shape->action_size = trace->header.joint_actions->count;
    return;
  }
}

}  // namespace

std::vector<CameraShape> cameras_of(const plan::Plan& plan, const plan::TaskRecord& task) {
  std::vector<CameraShape> all;
  for (const plan::ViewRecord& view : plan.views(task)) {
    const plan::CameraRecord& camera = plan.cameras()[view.camera];
    all.push_back({std::string(plan.text(view.name)), static_cast<int>(camera.width),
                   static_cast<int>(camera.height)});
  }
  return all;
}

bool is_success(const store::ResultRow& row) {
  return !row.invalid && std::ranges::any_of(row.metrics, [](const store::MetricValue& metric) {
    return metric.name == "success" && metric.is_bool && metric.value != 0;
  });
}

std::optional<std::string> lateness(const plan::Plan& plan, const store::ResultRow& row) {
  if (!row.live.empty())
    return "its world did not wait for its policy (" + row.live +
           "): actions answer earlier pictures, or are held";
  const auto task = plan.find_task(row.task);
  if (!task || plan.tasks()[*task].delay == 0) return std::nullopt;
  return fmt::format("`{}` has a delay: an action acts {} control steps after its picture",
                     row.task, plan.tasks()[*task].delay);
}

Result<Source> open_source(const std::string& dir, const DatasetOptions& options,
                           std::set<std::string>& taken, std::vector<std::string>& left_out) {
  PROBE_ASSIGN(const store::RunRecord record, store::read_run_record(dir));
  PROBE_ASSIGN(plan::Plan plan, store::open_run_plan(dir));
  PROBE_ASSIGN(const auto rows, store::read_results(dir));
  Source source{dir, record.identity.policy, is_pushed(record.identity), std::move(plan), {}, {},
                record.identity.until};
  std::map<std::string, std::pair<std::size_t, std::string>> invalid;  // by reason: how many, first
  std::map<std::string, std::size_t> late;                             // by reason
  std::size_t failed = 0, empty = 0, again = 0;
  std::set<std::uint32_t> tasks;
  for (const store::ResultRow& row : rows) {
    if (!matches_glob(options.tasks, row.task)) continue;
    const auto task = source.plan.find_task(row.task);
    if (row.invalid) {
      auto& [count, first] = invalid[*row.invalid];
      if (count++ == 0) first = store::to_text(store::key_of(row));
    } else if (options.only_success && !is_success(row)) {
      ++failed;
    } else if (row.steps == 0 || !task) {
      ++empty;
    } else if (const auto why = lateness(source.plan, row)) {
      ++late[*why];
    } else if (!taken.insert(row.trace_sha256).second) {
      ++again;
    } else {
      source.rows.push_back(row);
      tasks.insert(*task);
    }
  }
  source.tasks.assign(tasks.begin(), tasks.end());
  if (store::FolderLock::is_taken(dir))
    left_out.push_back(fmt::format("what `{}` does not have yet: it is being written now", dir));
  for (const auto& [why, of] : invalid)
    left_out.push_back(fmt::format("{} of `{}`, {} the first: {}{}", counted(of.first), dir,
                                   of.second, store::is_not_attempted(why) ? "" : "invalid, ",
                                   why));
  for (const auto& [why, count] : late)
    left_out.push_back(fmt::format("{} of `{}`: {}", counted(count), dir, why));
  if (again > 0)
    left_out.push_back(
        fmt::format("{} of `{}`: the same traces as in a run before it", counted(again), dir));
  if (failed > 0) left_out.push_back(fmt::format("{} of `{}`: no success", counted(failed), dir));
  if (empty > 0)
    left_out.push_back(
        fmt::format("{} of `{}`: no step of a task of its plan", counted(empty), dir));
  return source;
}

Result<Shape> shape_of(const std::vector<Source>& sources, const DatasetOptions& options) {
  std::optional<Shape> common;
  std::string first;
  for (const Source& source : sources) {
    for (const std::uint32_t index : source.tasks) {
      const plan::TaskRecord& task = source.plan.tasks()[index];
      const std::string name = fmt::format("`{}` of `{}`", source.plan.text(task.name), source.dir);
      PROBE_ASSIGN(Shape shape, shape_of_task(source.plan, task, options));
      add_actions(source, task, &shape);
      if (!common) {
        common = std::move(shape);
        first = name;
        continue;
      }
      const std::string differs = difference(*common, shape);
      if (!differs.empty()) {
        return Failure{
            Fault::kUsage,
            fmt::format("{} and {} do not go into one dataset: {}", first, name, differs),
            source.dir};
      }
    }
  }
  if (!common) return Failure{Fault::kUsage, "nothing to export", ""};
  return *common;
}

}  // namespace probe::dataset
