#include "runtime/inspect/roles_json.h"

#include <string>

#include "runtime/plan/roles.h"

namespace probe::inspect {

void add_roles(const plan::Plan& plan, const plan::TaskRecord& task, Json& json) {
  const plan::TaskRoles roles = plan::roles_of(plan.tables(), task);
  const auto bodies = plan.bodies(task);
  const auto name_of = [&](std::uint32_t object) {
    return object == plan::kNone ? Json() : Json(plan.text(plan.objects()[object].name));
  };
  const auto names_of = [&](std::uint32_t first, std::uint32_t count) {
    Json names = Json::array();
    for (const plan::BodyRecord& body : bodies.subspan(first, count))
      names.push_back(plan.text(body.name));
    return names;
  };
  json["source"] = name_of(task.source);
  json["target"] = name_of(task.target);
  for (const plan::RoleRecord& role : roles.things) {
    const std::string name(plan.text(role.name));
    const Json thing(plan::thing_in(plan.tables(), task, role));
    if (plan::is_part_distractor(role)) continue;
    if (role.kind == static_cast<std::uint32_t>(plan::RoleKind::kPartOfSet)) {
      json["roles"][name].push_back(thing);
    } else if (name == "source" || name == "target") {
      json[name] = thing;
    } else {
      json["roles"][name] = thing;
    }
  }
  for (const plan::RoleRecord& role : roles.others) {
    const auto kind = static_cast<plan::RoleKind>(role.kind);
    if (kind == plan::RoleKind::kPlaced) continue;
    json["roles"][std::string(plan.text(role.name))] =
        kind == plan::RoleKind::kOne ? Json(plan.text(bodies[role.first].name))
                                     : names_of(role.first, role.count);
  }
  json["distractors"] = names_of(roles.distractors.first, roles.distractors.count);
  for (const std::string_view part : plan::part_distractors_of(plan.tables(), task))
    json["distractors"].push_back(part);
  for (const plan::RoleRecord& role : roles.others) {
    if (role.kind == static_cast<std::uint32_t>(plan::RoleKind::kPlaced))
      json["placed"] = names_of(role.first, role.count);
  }
}

}  // namespace probe::inspect
