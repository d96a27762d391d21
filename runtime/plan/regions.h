// Whose a region is in a task. The references of the plan are verified, or are those of a writer.
#pragma once

#include <cstdint>
#include <optional>

#include "runtime/plan/tables.h"

namespace probe::plan {

// Whether the region is of something that a task has: its scene, one of its objects, or a part of
// one of its fixtures.
bool has_region(const Tables& tables, const TaskRecord& task, const RegionRecord& region);

// The task's body that it belongs to. Nothing where has_region is false, and for a region of what
// stands in a scene without a body, having no collision mesh.
std::optional<std::uint32_t> owner_of(const Tables& tables, const TaskRecord& task,
                                      const RegionRecord& region);

}  // namespace probe::plan
