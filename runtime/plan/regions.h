// Whose a region is in a task. The references of the plan are verified, or are those of a writer.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "runtime/plan/tables.h"

namespace probe::plan {

// The axes of a turned box: column i is axis i, in the frame that it is said in; whole numbers
// where it is turned by right angles.
std::array<std::array<double, 3>, 3> axes_of(const TurnedBox& box);

// The box around a turned one, along the axes of the frame that it is said in. Its bits are those
// of the plan: who writes a region and who verifies it ask here.
void box_around(const TurnedBox& box, std::array<double, 3>& low, std::array<double, 3>& high);

// A region as a box along its own axes, which are those of what it belongs to where it is not
// turned. `low` and `high` are the box around a turned one: whoever asks where a region is asks
// here.
TurnedBox box_of(const std::array<double, 3>& low, const std::array<double, 3>& high,
                 const std::optional<TurnedBox>& turned);
TurnedBox box_of(const Tables& tables, std::uint32_t region);

// What a region is along its own axes; nothing where these are those of what it belongs to.
std::optional<TurnedBox> turned_box(const Tables& tables, std::uint32_t region);

// Whether the region is of something that a task has: its scene, one of its objects, or a part of
// one of its fixtures.
bool has_region(const Tables& tables, const TaskRecord& task, const RegionRecord& region);

// The task's body that it belongs to. Nothing where has_region is false, and for a region of what
// stands in a scene without a body, having no collision mesh.
std::optional<std::uint32_t> owner_of(const Tables& tables, const TaskRecord& task,
                                      const RegionRecord& region);

}  // namespace probe::plan
