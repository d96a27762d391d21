#include "runtime/report/joined_plans.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#include "runtime/inspect/axes.h"
#include "runtime/plan/ids.h"
#include "runtime/plan/later.h"
#include "runtime/plan/places.h"
#include "runtime/plan/roles.h"
#include "runtime/plan/source_line.h"

namespace probe::report {
namespace {

std::string hex(const std::array<std::uint8_t, 32>& bytes) {
  return to_hex(plan::to_sha256(bytes));
}

int good_of(std::string_view metric) {
  for (const char* name : {"success", "intention", "grasp", "steady", "moved"}) {
    if (metric == name) return 1;
  }
  return metric == "wrong" ? -1 : 0;
}

double yaw_deg(const std::array<double, 4>& q) {
  const double yaw =
      std::atan2(2 * (q[0] * q[3] + q[1] * q[2]), 1 - 2 * (q[2] * q[2] + q[3] * q[3]));
  return yaw * 180 / std::numbers::pi;
}

// Empty where there is none.
std::string object_name(const plan::Plan& plan, std::uint32_t object) {
  return object == plan::kNone ? "" : std::string(plan.text(plan.objects()[object].name));
}

void quote_rule(const plan::Plan& plan, const plan::MetricRecord& metric, Task& task) {
  const auto index = static_cast<std::uint32_t>(&metric - plan.metrics().data());
  const plan::SpanRecord* span = plan.span_of(plan::SpanKind::kMetrics, index);
  if (span == nullptr) return;
  const plan::TextRecord& text = plan.texts()[span->text];
  const plan::SourceLine line = plan::line_at(plan.tables().source(text), span->begin);
  task.rule_file = plan.tables().path(text);
  task.rule_line = static_cast<int>(line.number);
  task.rule = line.text;
}

}  // namespace

int JoinedPlans::add(plan::Plan plan, const std::string& suite_name) {
  const std::string root = to_hex(plan.root());
  for (std::size_t i = 0; i < benchmark_.plans.size(); ++i) {
    if (benchmark_.plans[i].root == root && benchmark_.plans[i].suite == suite_name)
      return static_cast<int>(i);
  }
  PlanInfo info{root, suite_name, "", 0, 0, 1};
  const auto suite = plan.find_suite(suite_name);
  if (suite) {
    info.trained_on = plan.text(plan.suites()[*suite].trained_on);
    info.seeds = static_cast<int>(plan.seeds(plan.suites()[*suite]).size());
  }
  std::vector<std::uint32_t> members;
  if (suite) {
    const auto of_suite = plan.members(plan.suites()[*suite]);
    members.assign(of_suite.begin(), of_suite.end());
  } else {
    for (std::uint32_t t = 0; t < plan.tasks().size(); ++t) members.push_back(t);
  }
  info.tasks = static_cast<int>(members.size());
  for (const std::uint32_t t : members) {
    info.starts += static_cast<int>(suite ? plan.episodes(plan.suites()[*suite], t).size()
                                          : plan.episodes(plan.tasks()[t]).size());
  }
  benchmark_.plans.push_back(std::move(info));
  benchmark_.plan_files.push_back(std::move(plan));
  members_.push_back(std::move(members));
  add_tasks(static_cast<int>(benchmark_.plans.size()) - 1);
  return static_cast<int>(benchmark_.plans.size()) - 1;
}

int JoinedPlans::metric(const std::string& name, bool truth) {
  for (std::size_t i = 0; i < benchmark_.metrics.size(); ++i) {
    if (benchmark_.metrics[i].name == name) return static_cast<int>(i);
  }
  benchmark_.metrics.push_back({name, truth, truth ? good_of(name) : 0});
  return static_cast<int>(benchmark_.metrics.size()) - 1;
}

int JoinedPlans::object(const plan::Plan& plan, std::uint32_t index) {
  const std::string name(plan.text(plan.objects()[index].name));
  for (std::size_t i = 0; i < benchmark_.objects.size(); ++i) {
    if (benchmark_.objects[i].name == name) return static_cast<int>(i);
  }
  benchmark_.objects.push_back({name, std::nullopt, std::nullopt});
  return static_cast<int>(benchmark_.objects.size()) - 1;
}

void JoinedPlans::add_tasks(int index) {
  const plan::Plan& plan = benchmark_.plan_files[static_cast<std::size_t>(index)];
  PlanTasks map;
  map.task.resize(plan.tasks().size(), kAbsent);
  map.start.resize(plan.tasks().size());
  for (std::uint32_t t = 0; t < plan.tasks().size(); ++t) add_task(plan, index, t, map);
  for (std::uint32_t t = 0; t < plan.tasks().size(); ++t) {
    const std::uint32_t baseline = plan.tasks()[t].baseline;
    Task& task = benchmark_.tasks[static_cast<std::size_t>(map.task[t])];
    if (task.plan == index && baseline != plan::kNone) task.baseline = map.task[baseline];
  }
  maps_.push_back(std::move(map));
}

void JoinedPlans::add_task(const plan::Plan& plan, int index, std::uint32_t t, PlanTasks& map) {
  const plan::TaskRecord& record = plan.tasks()[t];
  const std::string name(plan.text(record.name));
  const auto key = std::tuple(name, plan::whole_instruction(plan.tables(), t), hex(record.judge_id),
                              object_name(plan, record.source), object_name(plan, record.target));
  const auto [known, fresh] = by_content_.try_emplace(key, benchmark_.tasks.size());
  map.task[t] = static_cast<int>(known->second);
  if (fresh) benchmark_.tasks.push_back(describe(plan, index, t));
  Task& task = benchmark_.tasks[known->second];
  for (const plan::EpisodeRecord& episode : plan.episodes(record)) {
    const std::string id = hex(episode.episode_id);
    auto at = std::find_if(task.starts.begin(), task.starts.end(),
                           [&](const StartPlace& start) { return start.episode_id == id; });
    if (at == task.starts.end()) {
      task.starts.push_back(place(plan, record, episode));
      at = task.starts.end() - 1;
    }
    map.start[t].push_back(static_cast<int>(at - task.starts.begin()));
  }
}

StartPlace JoinedPlans::place(const plan::Plan& plan, const plan::TaskRecord& task,
                              const plan::EpisodeRecord& episode) {
  StartPlace place;
  place.start_id = hex(episode.start_id);
  place.episode_id = hex(episode.episode_id);
  for (const plan::PlacementRecord& body : plan.placements(episode))
    place.bodies.push_back({body.position[0], body.position[1], yaw_deg(body.rotation)});
  place.cluster = clusters_(plan::place_key(plan, task, episode));
  place.taken = taken_(plan::taken_key(plan, task, episode));
  return place;
}

Task JoinedPlans::describe(const plan::Plan& plan, int index, std::uint32_t t) {
  const plan::TaskRecord& record = plan.tasks()[t];
  Task task;
  task.name = plan.text(record.name);
  for (const Task& other : benchmark_.tasks) {
    if (other.name != task.name) continue;
    task.name = name_apart(task.name, to_hex(plan.root()));
    two_meanings_.push_back(other.name);
    break;
  }
  task.prompt = plan.text(record.prompt);
  for (const plan::LaterRecord& later : plan::later_of(plan.tables(), t))
    task.later.emplace_back(plan.text(later.text));
  index_in(benchmark_.prompts, task.prompt);
  task.plan = index;
  task.axes = record.axes;
  task.axis_names = plan::moved_axes(plan.tables(), record);
  const plan::TaskRoles roles = plan::roles_of(plan.tables(), record);
  const auto objects_of = [&](std::uint32_t first, std::uint32_t count) {
    std::vector<int> objects;
    for (const plan::BodyRecord& body : plan.bodies(record).subspan(first, count))
      objects.push_back(object(plan, body.index));
    return objects;
  };
  if (roles.has_source()) task.source = object(plan, record.source);
  if (roles.has_target()) task.target = object(plan, record.target);
  for (const plan::RoleRecord& role : roles.others)
    task.roles.push_back({std::string(plan.text(role.name)), objects_of(role.first, role.count)});
  task.distractors = objects_of(roles.distractors.first, roles.distractors.count);
  for (std::size_t bit = 0; bit < plan::kNovelty.size(); ++bit) {
    if ((record.ood >> bit & 1U) != 0) task.ood.emplace_back(plan::kNovelty[bit]);
  }
  if (roles.has_source())
    benchmark_.objects[static_cast<std::size_t>(task.source)].seen_as_source =
        (record.ood & 1U) == 0;
  if (roles.has_target())
    benchmark_.objects[static_cast<std::size_t>(task.target)].seen_as_target =
        (record.ood & 2U) == 0;
  const plan::SceneRecord& scene = plan.scenes()[record.scene];
  task.scene = plan.text(scene.name);
  task.horizon = static_cast<int>(record.horizon);
  task.hz = plan.robots()[scene.robot].control_hz;
  for (const plan::MetricRecord& m : plan.metrics(record)) {
    const std::string name(plan.text(m.name));
    task.metrics.push_back(
        metric(name, m.type == static_cast<std::uint32_t>(plan::MetricType::kBool)));
    if (name == "success") quote_rule(plan, m, task);
  }
  task.allowed = plan.text(record.allow);
  if (record.baseline != plan::kNone && std::popcount(record.axes) > 1) {
    std::string axes;
    for (const std::string& axis : task.axis_names) axes += (axes.empty() ? "" : ", ") + axis;
    task.confounded =
        fmt::format("moves {} at once{}{}", axes, task.allowed.empty() ? "" : ": ", task.allowed);
  }
  return task;
}

}  // namespace probe::report
