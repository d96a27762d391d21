// The table of tasks while it is being filled: written tasks first, then those of every `derive`.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "compiler/model/mentioned.h"
#include "compiler/names/context.h"

namespace probe::sema {

// More than any suite that is run; less than what fills a memory by accident.
inline constexpr std::size_t kMaxTasks = 200'000;
inline constexpr std::size_t kMaxEpisodes = 5'000'000;

class TaskTable {
 public:
  // One empty row for each declared task.
  explicit TaskTable(Context& context);

  void add_row();
  void drop_last_row();
  // Reads declared task `index`; its parent must have been read.
  void define(std::uint32_t index, std::optional<std::uint32_t> parent);
  // Finds the baseline and what differs from it. An unknown name is reported at the last chance.
  void compare(std::uint32_t index, bool last_chance);

  bool is_defined(TaskId id) const { return defined_[static_cast<std::size_t>(id)]; }

 private:
  // Null when it was added to what was said before.
  Diagnostic* report_missing(const Task& task, const std::string& missing);
  // False when a role is spoken of that nothing fills; every task's own mistakes poison it.
  bool check_filled(const Task& task, bool& poisoned);

  Context& context_;
  MentionedIn mentioned_;
  std::map<std::pair<TaskId, std::string>, Diagnostic*> missing_;  // by what is copied
  std::vector<bool> poison_;  // has a statement that was reported
  std::vector<bool> defined_;
};

// Adds the tasks of every `derive`, in the order of the text: each sees all tasks that are written
// out and those of the derives above it.
void expand_derives(Context& context, TaskTable& table);

// How an object of a task is put down: the turns that the task gives it, or its own.
const std::vector<Turn>& rest_of(const Model& model, const Task& task, ObjectId object);

// Its objects by name, for messages: "carrot, plate".
std::string objects_text(const Model& model, const Task& task);

// Where an object came into a task: its name in the task's own declaration, when it stands there.
std::optional<Span> entry_of(const Task& task, ObjectId object);

}  // namespace probe::sema
