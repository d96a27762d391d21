#include "runtime/stage/task_bodies.h"

#include <string>

#include "runtime/base/check.h"

namespace probe::stage {

Result<TaskBodies> task_bodies(const plan::Plan& plan, const plan::TaskRecord& task,
                               const robot::RobotModel& model) {
  const auto bodies = plan.bodies(task);
  TaskBodies out;
  out.count = bodies.size();
  out.objects = 2 + task.distractors;
  std::size_t objects = 0;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const auto local = static_cast<std::uint16_t>(i);
    switch (static_cast<plan::BodyKind>(bodies[i].kind)) {
      case plan::BodyKind::kObject:
        ++objects;
        break;
      case plan::BodyKind::kSurface:
        out.surface = local;
        break;
      case plan::BodyKind::kFixture:
        out.fixture = local;
        break;
      case plan::BodyKind::kLink: {
        if (out.links.empty()) out.first_link = local;
        const std::string name(plan.text(bodies[i].name));
        const int link = model.find_link(name);
        if (link < 0) return Failure{Fault::kUrdf, "no link `" + name + "`", model.path};
        out.links.push_back(link);
        break;
      }
    }
  }
  if (objects == out.objects) return out;
  return Failure{Fault::kPlan, "bodies and distractors do not add up",
                 "task `" + std::string(plan.text(task.name)) + "`"};
}

std::uint16_t TaskBodies::local(const world::Party& party) const {
  switch (party.kind) {
    case world::PartyKind::kSurface:
      return surface;
    case world::PartyKind::kLink:
      PROBE_CHECK(party.index < links.size(), "only the robot's links are bodies of a task");
      return static_cast<std::uint16_t>(first_link + party.index);
    case world::PartyKind::kFixture:
      return fixture;
    case world::PartyKind::kBody:
      break;
  }
  return party.index;
}

}  // namespace probe::stage
