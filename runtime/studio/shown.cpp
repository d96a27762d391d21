#include "runtime/studio/shown.h"

#include <algorithm>
#include <filesystem>

#include "runtime/plan/later.h"
#include "runtime/plan/roles.h"

namespace probe::studio {
namespace {

// What an object is in a task: "source", "distractor"; empty where it is nothing there.
std::string role_of(const plan::Plan& plan, const plan::TaskRecord& task, std::string_view object) {
  const plan::TaskRoles roles = plan::roles_of(plan.tables(), task);
  const auto bodies = plan.bodies(task);
  for (std::uint32_t body = 0; body < roles.objects; ++body) {
    if (plan.text(bodies[body].name) == object)
      return std::string(plan::role_of_body(plan.tables(), roles, body));
  }
  for (const plan::RoleRecord& role : roles.things) {
    if (plan::thing_in(plan.tables(), task, role) == object)
      return plan::is_part_distractor(role) ? "distractor" : std::string(plan.text(role.name));
  }
  return "";
}

Json task_json(const Shown& shown, const plan::TaskRecord& task) {
  const plan::Plan& plan = shown.plan;
  const std::string_view name = plan.text(task.name);
  Json out = Json::object();
  out["name"] = name;
  out["prompt"] = plan::whole_instruction(
      plan.tables(), static_cast<std::uint32_t>(&task - plan.tasks().data()));
  out["baseline"] =
      task.baseline == plan::kNone ? Json() : Json(plan.text(plan.tasks()[task.baseline].name));
  out["axes"] = plan::moved_axes(plan.tables(), task);
  out["starts"] = task.episodes.count;
  out["horizon"] = task.horizon;
  out["hz"] = plan.robots()[plan.scenes()[task.scene].robot].control_hz;
  Json words = Json::array();
  for (const ReferringWords& said : shown.referring) {
    if (said.task != name) continue;
    words.push_back({{"words", said.words},
                     {"object", said.object},
                     {"role", role_of(plan, task, said.object)}});
  }
  out["words"] = std::move(words);
  Json metrics = Json::array();
  for (const plan::MetricRecord& metric : plan.metrics(task)) {
    metrics.push_back(
        {{"name", plan.text(metric.name)},
         {"truth", metric.type == static_cast<std::uint32_t>(plan::MetricType::kBool)}});
  }
  out["metrics"] = std::move(metrics);
  return out;
}

}  // namespace

std::vector<bool> own_tasks(const plan::Plan& plan, const std::string& file) {
  // Paths of a plan's texts are relative to the folder of the first.
  const std::string name = std::filesystem::path(file).filename().string();
  std::vector<bool> own;
  for (std::uint32_t task = 0; task < plan.tasks().size(); ++task) {
    const plan::SpanRecord* span = plan.span_of(plan::SpanKind::kTasks, task);
    own.push_back(span != nullptr && plan.tables().path(plan.texts()[span->text]) == name);
  }
  return own;
}

std::optional<std::uint32_t> find_shown(const Shown& shown, const std::string& name) {
  if (shown.plan.tasks().size() == 0) return std::nullopt;
  if (!name.empty()) {
    if (const auto found = shown.plan.find_task(name)) return found;
  }
  const auto own = std::ranges::find(shown.is_own, true);
  return own == shown.is_own.end() ? 0 : static_cast<std::uint32_t>(own - shown.is_own.begin());
}

Json summary(const Shown& shown) {
  const plan::Plan& plan = shown.plan;
  Json tasks = Json::array();
  std::size_t episodes = 0;
  for (std::uint32_t index = 0; index < plan.tasks().size(); ++index) {
    const plan::TaskRecord& task = plan.tasks()[index];
    tasks.push_back(task_json(shown, task));
    tasks.back()["is_own"] = static_cast<bool>(shown.is_own[index]);
    episodes += task.episodes.count;
  }
  Json suites = Json::array();
  for (const plan::SuiteRecord& suite : plan.suites()) {
    suites.push_back({{"name", plan.text(suite.name)},
                      {"tasks", plan.members(suite).size()},
                      {"episodes", plan.episode_count(suite)}});
  }
  Json out = Json::object();
  out["tasks"] = std::move(tasks);
  out["episodes"] = episodes;
  out["suites"] = std::move(suites);
  return out;
}

}  // namespace probe::studio
