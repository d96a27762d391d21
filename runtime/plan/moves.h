// Ways that objects take by themselves: where they are at a time, and their words.
#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/plan/tables.h"

namespace probe::plan {

// "", "loop", "once", "around": as a text says them; back and forth is not said.
std::string_view to_text(Way way);

// The legs of each object of a task that moves, in the order of the bodies.
std::vector<std::span<const MoveRecord>> moves_of(const Tables& tables, const TaskRecord& task);

// Of the legs of one object: where it is `seconds` after its first step began, from where it lay
// (m, x and y of the world). Back and forth, the first leg's beginning is the last one's end; in a
// circle counterclockwise as seen from above.
std::array<double, 2> offset_at(std::span<const MoveRecord> legs, double seconds);
// When it stands still for good (s); infinite but for `once`.
double moves_until(std::span<const MoveRecord> legs);
// The corners of its way in their order, from (0, 0) on; of a circle `kCirclePoints` of its points.
inline constexpr int kCirclePoints = 72;
std::vector<std::array<double, 2>> corners_of(std::span<const MoveRecord> legs);

// "along (5cm, 0cm) at 5cm/s once".
std::string move_text(std::span<const MoveRecord> legs);

}  // namespace probe::plan
