// What was recorded of the benchmark's own program, as files: its tasks, the states behind the ten
// steps of waiting, steps of the arm. A folder of records has what it has; rows of `fidelity` that
// lack theirs are not measured.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "runtime/base/geometry.h"
#include "runtime/base/json.h"
#include "runtime/base/result.h"

namespace probe::libero {

enum class JsonKind { kObject, kArray, kText, kNumber };
// A member of an object. Fails (kUsage) naming what is not there, or is of another kind.
Result<const Json*> member(const Json& of, const std::string& key, JsonKind kind,
                           const std::string& where);
// The same of finite numbers, so many of them (0: as many as there are).
Result<std::vector<double>> numbers(const Json& of, const std::string& key, std::size_t count,
                                    const std::string& where);

struct RecordedTask {
  std::string suite, stem;   // "libero_goal", "open_the_middle_drawer_of_the_cabinet"
  std::size_t index = 0;     // within its suite
  std::string key() const;   // "libero_goal_00"
  std::string name() const;  // of the task in the imported text
  Json said;                 // its entry
};

// A state of MuJoCo's as LIBERO stores it, in its own order.
struct RecordedState {
  std::vector<double> arm;             // rad, seven
  std::vector<double> fingers;         // m, two; the second counts downwards
  std::vector<Pose> objects;           // in the order of the task's objects
  std::vector<double> fixture_joints;  // m, rad
};

class Records {
 public:
  // Fails (kUsage) where the folder has no libero_tasks.json, or one that lacks what is asked of
  // it.
  static Result<Records> open(const std::string& folder);

  const std::string& folder() const { return folder_; }
  const std::vector<RecordedTask>& tasks() const { return tasks_; }
  // Without these, which are gone then.
  void leave_out(const std::function<bool(const RecordedTask&)>& which) {
    std::erase_if(tasks_, which);
  }
  bool has(const std::string& file) const;
  Result<std::string> text(const std::string& file) const;
  Result<Json> json(const std::string& file) const;

  // libero_settled.npz: by start; empty where the archive has none of this task. Fails (kUsage) on
  // rows that are not float64, that are narrower than the task's state or not finite.
  Result<std::vector<RecordedState>> settled(const RecordedTask& task) const;
  // `state_t10` of reference/TASK_state.json: its first start behind the waiting steps, with
  // fixtures where that run had them; nothing where there is no such file. Fails (kUsage) on what
  // is no state.
  Result<std::optional<RecordedState>> behind_waiting(const RecordedTask& task) const;

 private:
  std::string folder_;
  std::vector<RecordedTask> tasks_;
};

// A table with a header, every cell a finite number.
struct RecordedTable {
  std::vector<std::string> names;
  std::vector<std::vector<double>> rows;
  // Of a row that the table has, by name; fails (kUsage) where there is no such column.
  Result<std::size_t> column(const std::string& name) const;
};
Result<RecordedTable> read_table(const std::string& text, const std::string& where);

}  // namespace probe::libero
