// Sets of tasks as records.
#include "compiler/emit/emitter.h"

namespace probe::emit {

plan::Slice Emitter::add_members(const std::vector<TaskId>& members) {
  std::vector<std::uint32_t> indices;
  for (const TaskId id : members) {
    if (tasks_[id] != plan::kNone) indices.push_back(tasks_[id]);
  }
  return writer_.list(indices);
}

void Emitter::add_sets() {
  for (const sema::TaskSet& set : model_.sets) {
    plan::SetRecord record;
    record.name = writer_.text(set.name);
    record.members = add_members(set.members);
    records().sets.push_back(record);
  }
}

}  // namespace probe::emit
