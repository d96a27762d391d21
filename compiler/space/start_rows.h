// A point's starts as a table: those of the task, with what the point moves moved and its clutter
// beside it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "compiler/space/points.h"

namespace probe::space {

// What lies around beside the task's own, by name: a thing that is wanted more often than the
// space lists it is a copy.
struct Clutter {
  std::vector<sema::ObjectId> objects;
  std::vector<std::string> names;
  std::string declarations;  // of the copies
};
Clutter clutter_of(const sema::Model& model, const sema::Space& space, const Point& point);

// Whether the point needs a table: it moves things, or has not all starts.
bool has_own_starts(const sema::Model& model, const sema::Space& space, const Point& point);

struct StartRows {
  std::vector<std::uint32_t> starts;  // by the task's own numbers
  std::string table;
  std::string left_out;  // why there is none
};
StartRows start_rows(const sema::Model& model, const sema::Space& space, const Point& point,
                     const Clutter& clutter, const sema::PartBoxes& ways);

}  // namespace probe::space
