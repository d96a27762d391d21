#include "runtime/plan/roles.h"

#include <algorithm>

#include "runtime/plan/axes.h"

namespace probe::plan {
namespace {

// The objects of a role, in its order; none where the task has no such role.
std::vector<std::uint32_t> objects_in(const Tables& tables, const TaskRecord& task,
                                      std::string_view name) {
  std::vector<std::uint32_t> objects;
  const TaskRoles roles = roles_of(tables, task);
  if (const RoleRecord* role = find_role(tables, roles, name)) {
    for (const BodyRecord& body :
         slice_of(tables.bodies, {task.bodies.first + role->first, role->count}))
      objects.push_back(body.index);
  }
  return objects;
}

bool is_placed(const RoleRecord& role) {
  return role.kind == static_cast<std::uint32_t>(RoleKind::kPlaced);
}

const RoleRecord* role_with(const TaskRoles& roles, std::uint32_t body) {
  for (const RoleRecord& role : roles.others) {
    if (body >= role.first && body - role.first < role.count) return &role;
  }
  return nullptr;
}

}  // namespace

bool is_of_thing(const RoleRecord& role) {
  return role.kind == static_cast<std::uint32_t>(RoleKind::kPart) ||
         role.kind == static_cast<std::uint32_t>(RoleKind::kRegion) ||
         role.kind == static_cast<std::uint32_t>(RoleKind::kPartOfSet) || is_part_distractor(role);
}

bool is_part_distractor(const RoleRecord& role) {
  return role.kind == static_cast<std::uint32_t>(RoleKind::kPartDistractor);
}

std::string_view thing_in(const Tables& tables, const TaskRecord& task, const RoleRecord& role) {
  if (role.kind == static_cast<std::uint32_t>(RoleKind::kRegion))
    return tables.text(tables.regions[role.first].name);
  return tables.text(slice_of(tables.bodies, task.bodies)[role.first].name);
}

std::string_view thing_in(const Tables& tables, const TaskRecord& task, std::string_view name) {
  const std::vector<std::string_view> things = things_in(tables, task, name);
  return things.empty() ? std::string_view() : things.front();
}

std::vector<std::string_view> things_in(const Tables& tables, const TaskRecord& task,
                                        std::string_view name) {
  std::vector<std::string_view> things;
  for (const RoleRecord& role : roles_of(tables, task).things) {
    if (tables.text(role.name) == name && !is_part_distractor(role))
      things.push_back(thing_in(tables, task, role));
  }
  return things;
}

std::vector<std::string_view> part_distractors_of(const Tables& tables, const TaskRecord& task) {
  std::vector<std::string_view> parts;
  for (const RoleRecord& role : roles_of(tables, task).things) {
    if (is_part_distractor(role)) parts.push_back(thing_in(tables, task, role));
  }
  return parts;
}

TaskRoles roles_of(const Tables& tables, const TaskRecord& task) {
  TaskRoles roles;
  std::uint32_t next = 0, placed = 0;
  if (task.source != kNone) roles.source = next++;
  if (task.target != kNone) roles.target = next++;
  const std::span<const RoleRecord> all = slice_of(tables.roles, task.roles);
  std::size_t own = all.size();
  while (own > 0 && is_of_thing(all[own - 1])) --own;
  roles.others = all.first(own);
  roles.things = all.subspan(own);
  for (const RoleRecord& role : roles.others) {
    if (is_placed(role)) placed += role.count;
    if (!is_placed(role)) next += role.count;
  }
  roles.distractors = {next, task.distractors};
  roles.objects = next + task.distractors + placed;
  return roles;
}

std::string_view role_of_body(const Tables& tables, const TaskRoles& roles, std::uint32_t body) {
  if (body == roles.source) return "source";
  if (body == roles.target) return "target";
  if (roles.is_distractor(body)) return "distractor";
  const RoleRecord* role = role_with(roles, body);
  return role == nullptr ? std::string_view() : tables.text(role->name);
}

std::string label_of_body(const Tables& tables, const TaskRoles& roles, std::uint32_t body) {
  const std::string name(role_of_body(tables, roles, body));
  if (name == "distractor") return name + " " + std::to_string(body - roles.distractors.first + 1);
  const RoleRecord* role = role_with(roles, body);
  if (role == nullptr || role->kind == static_cast<std::uint32_t>(RoleKind::kOne)) return name;
  return (is_placed(*role) ? "placed" : name) + " " + std::to_string(body - role->first + 1);
}

const RoleRecord* find_role(const Tables& tables, const TaskRoles& roles, std::string_view name) {
  const auto at = std::find_if(
      roles.others.begin(), roles.others.end(),
      [&](const RoleRecord& role) { return !is_placed(role) && tables.text(role.name) == name; });
  return at == roles.others.end() ? nullptr : &*at;
}

std::vector<std::string> axis_names_between(const Tables& tables, std::uint32_t mask,
                                            const TaskRecord& a, const TaskRecord& b) {
  std::vector<std::string> names;
  for (const Axis axis : axes_in(mask)) {
    if (axis != Axis::kObjectOther) {
      names.emplace_back(axis_name(axis));
      continue;
    }
    std::vector<std::string_view> known;
    for (const TaskRecord* task : {&a, &b}) {
      for (const RoleRecord& role : roles_of(tables, *task).others) {
        const std::string_view name = tables.text(role.name);
        if (is_placed(role) || std::find(known.begin(), known.end(), name) != known.end()) continue;
        known.push_back(name);
        if (objects_in(tables, a, name) != objects_in(tables, b, name) ||
            things_in(tables, a, name) != things_in(tables, b, name))
          names.push_back("object." + std::string(name));
      }
      for (const RoleRecord& role : roles_of(tables, *task).things) {
        const std::string_view name = tables.text(role.name);
        if (is_part_distractor(role) || name == "source" || name == "target" ||
            std::find(known.begin(), known.end(), name) != known.end())
          continue;
        known.push_back(name);
        if (!objects_in(tables, a, name).empty() || !objects_in(tables, b, name).empty() ||
            things_in(tables, a, name) != things_in(tables, b, name))
          names.push_back("object." + std::string(name));
      }
    }
  }
  return names;
}

std::vector<std::string> moved_axes(const Tables& tables, const TaskRecord& task) {
  if (task.baseline == kNone) return {};
  return axis_names_between(tables, task.axes, task, tables.tasks[task.baseline]);
}

}  // namespace probe::plan
