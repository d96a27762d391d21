// A thing of a task put elsewhere by another number in the text: who drags it in a picture writes
// `place ... at (x, y)`.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/diag/diagnostic.h"
#include "compiler/language/snapshot.h"
#include "runtime/base/result.h"

namespace probe::language {

// A way from where a thing is seen to where it is wanted: m, x and y of the world.
struct Move {
  std::array<double, 2> from{}, to{};
};

// The numbers that say where `object` stands in the starts of `task` as they have to be after the
// move, in the units that they are written in and whole millimetres. What is seen may be older than
// the text: a thing that has a place of its own gets `to`, whatever its place is by now. Of a thing
// that stands in cells, or jitters, the numbers change by as much as it moved; cells are a grid's,
// which moves as a whole. Nothing changes along an axis by less than half a millimetre.
// Fails (kUsage) where the task or the object is none of the text, and where no number of it says
// where that stands: it is put on another thing, or its starts are a table's.
Result<std::vector<Replacement>> moved(const Snapshot& snapshot, std::string_view task,
                                       std::string_view object, const Move& move);

}  // namespace probe::language
