#include "runtime/stage/task_bodies.h"

#include "runtime/base/check.h"
#include "runtime/plan/roles.h"

namespace probe::stage {

Result<TaskBodies> task_bodies(const plan::Plan& plan, const plan::TaskRecord& task,
                               const SharedAssets& assets) {
  const UrdfParts* robot = assets.robot(plan.robots()[plan.scenes()[task.scene].robot].urdf);
  PROBE_CHECK(robot != nullptr, "assets are loaded for the tasks that run");
  TaskBodies out;
  out.objects = plan::roles_of(plan.tables(), task).objects;
  std::size_t objects = 0, parts = 0;
  for (const plan::BodyRecord& body : plan.bodies(task)) {
    const auto local = static_cast<std::uint16_t>(out.count());
    out.names.emplace_back(plan.text(body.name));
    switch (static_cast<plan::BodyKind>(body.kind)) {
      case plan::BodyKind::kObject:
        ++objects;
        break;
      case plan::BodyKind::kSurface:
        out.surface = local;
        break;
      case plan::BodyKind::kFixture:
        out.fixture = local;
        break;
      case plan::BodyKind::kPart:
        ++parts;
        break;
      case plan::BodyKind::kLink: {
        const int link = robot->model.find_link(out.names.back());
        if (link < 0) {
          return Failure{Fault::kUrdf, "no link `" + out.names.back() + "`", robot->model.path};
        }
        out.links.push_back({0, link});
        break;
      }
    }
  }
  if (objects != out.objects) {
    return Failure{Fault::kPlan, "bodies and roles do not add up",
                   "task `" + std::string(plan.text(task.name)) + "`"};
  }
  out.first_link = static_cast<std::uint16_t>(out.count() - out.links.size() - parts);
  out.robot_links = out.links.size();
  std::size_t tree = 0;
  for (const LoadedFixture* loaded : assets.fixtures(task.scene)) {
    ++tree;
    for (std::size_t link = 0; link < loaded->parts.shapes.size(); ++link) {
      if (loaded->parts.shapes[link] == nullptr) continue;
      out.links.push_back({tree, static_cast<int>(link)});
      if (loaded->is_planned) continue;  // named by the plan
      out.names.push_back(name_in(loaded->fixture, loaded->parts.model.links[link].name));
    }
  }
  if (out.first_link + out.links.size() != out.count()) {
    return Failure{Fault::kPlan, "its parts are not the links of its fixtures that can be touched",
                   "task `" + std::string(plan.text(task.name)) + "`"};
  }
  return out;
}

std::uint16_t TaskBodies::local(const world::Party& party) const {
  switch (party.kind) {
    case world::PartyKind::kSurface:
      return surface;
    case world::PartyKind::kLink:
      PROBE_CHECK(party.index < links.size(), "every link of the world is a body of the task");
      return static_cast<std::uint16_t>(first_link + party.index);
    case world::PartyKind::kFixture:
      return fixture;
    case world::PartyKind::kBody:
      break;
  }
  return party.index;
}

std::optional<std::uint16_t> TaskBodies::of_link(std::size_t tree, int link) const {
  for (std::size_t k = 0; k < links.size(); ++k) {
    if (links[k].tree == tree && links[k].link == link) {
      return static_cast<std::uint16_t>(first_link + k);
    }
  }
  return std::nullopt;
}

}  // namespace probe::stage
