// Which body of a task has which role: the one place that knows the order of a task's objects.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/plan/tables.h"

namespace probe::plan {

// Bodies of a task. Those below `objects` are its objects, and the placements of its episodes are
// in their order.
struct TaskRoles {
  std::uint32_t source = kNone, target = kNone;  // a body, or none
  std::span<const RoleRecord> others;  // declared roles and, last, what the layout placed by name
  // Roles, `source` and `target`, too, of parts and regions; a record for each part of a set, and,
  // without a name, for each that is a distractor.
  std::span<const RoleRecord> things;
  Slice distractors;
  std::uint32_t objects = 0;

  bool is_distractor(std::uint32_t body) const {
    return body >= distractors.first && body - distractors.first < distractors.count;
  }
  bool has_source() const { return source != kNone; }
  bool has_target() const { return target != kNone; }
  // What most of the field's tasks are: one thing goes to another.
  bool has_both() const { return has_source() && has_target(); }
};

// Filled with a part or a region of a fixture, or a part that is a distractor.
bool is_of_thing(const RoleRecord& role);
bool is_part_distractor(const RoleRecord& role);

// The references of the task are verified, or are those of a writer.
TaskRoles roles_of(const Tables& tables, const TaskRecord& task);

// The role that a body below `objects` has: "source", "helper", "distractor"; empty for an object
// that is in none.
std::string_view role_of_body(const Tables& tables, const TaskRoles& roles, std::uint32_t body);
// The same, told apart where several have it: "distractor 2", "goods 1"; "placed 1" for one in
// none.
std::string label_of_body(const Tables& tables, const TaskRoles& roles, std::uint32_t body);

// The part or region that fills a role: "cabinet.inside_top". One of the task's `things`.
std::string_view thing_in(const Tables& tables, const TaskRecord& task, const RoleRecord& role);
// The same by the role's name, the first of a set; empty where an object fills it or nothing.
std::string_view thing_in(const Tables& tables, const TaskRecord& task, std::string_view role);
// All of a role, of a set in their order; empty where none fills it.
std::vector<std::string_view> things_in(const Tables& tables, const TaskRecord& task,
                                        std::string_view role);
// The parts that are distractors, in their order.
std::vector<std::string_view> part_distractors_of(const Tables& tables, const TaskRecord& task);

// The declared role of that name; null where the task has none.
const RoleRecord* find_role(const Tables& tables, const TaskRoles& roles, std::string_view name);

// The names of the axes of `mask` between two tasks; roles beside source and target under their
// own: "object.helper".
std::vector<std::string> axis_names_between(const Tables& tables, std::uint32_t mask,
                                            const TaskRecord& a, const TaskRecord& b);
// Of a variant against its baseline: what it was declared to move.
std::vector<std::string> moved_axes(const Tables& tables, const TaskRecord& task);

}  // namespace probe::plan
