// The ordered enumeration of a layout for the objects of one task: the first line varies slowest,
// the last fastest.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/diag/diagnostic.h"
#include "compiler/model/model.h"

namespace probe::sema {

// Why a layout gives no starts for a task.
struct LayoutProblem {
  Situation what = Situation::kNotPlaced;
  std::string message;
  Span span;  // within the layout
  std::string_view label = "the layout";
  std::string advice = {};
};

class Supports;
// Starts in episode order, at most `most`. On a problem the list is empty and `problem` is set.
std::vector<Start> enumerate_starts(Supports& supports, const Model& model, const Layout& layout,
                                    const Task& task, std::size_t most,
                                    std::optional<LayoutProblem>& problem);

// The row of a layout's table that places an object in a start of this task; null where none does.
const GivenPlace* row_of(const Model& model, const Layout& layout, const Task& task,
                         const Start& start, ObjectId id);

class Relations;
// Of these, the starts in which the task's chosen phrases are clear.
std::vector<Start> clear_starts(Relations& relations, const Model& model, const Task& task,
                                std::vector<Start> starts);

// How many objects have a role: they come first in a start.
std::size_t roles_filled(const Task& task);

// Whether two tasks have as many starts, and in each what is in both lies at the same place,
// whatever its role, and so does what fills the role of an object that is in one only.
bool start_at_same_places(const Task& a, const Task& b);
// Whether the starts of two tasks correspond one by one: what is compared is then compared start by
// start, else only in the mean. In one scene, the same places of what fills roles, or of all but
// distractors whichever has which role: as the report pairs them, by plan::place_key and taken_key.
bool starts_correspond(const Task& a, const Task& b);

}  // namespace probe::sema
