#include "runtime/plan/regions.h"

namespace probe::plan {
namespace {

// Surface and what stands are one each in a scene, whose number their regions have.
bool is_of_scene(const RegionRecord& region) {
  return region.kind == static_cast<std::uint32_t>(BodyKind::kSurface) ||
         region.kind == static_cast<std::uint32_t>(BodyKind::kFixture);
}

}  // namespace

bool has_region(const Tables& tables, const TaskRecord& task, const RegionRecord& region) {
  return is_of_scene(region) ? region.index == task.scene
                             : owner_of(tables, task, region).has_value();
}

std::optional<std::uint32_t> owner_of(const Tables& tables, const TaskRecord& task,
                                      const RegionRecord& region) {
  const auto bodies = slice_of(tables.bodies, task.bodies);
  for (std::uint32_t b = 0; b < bodies.size(); ++b) {
    const bool is_it =
        is_of_scene(region) ? region.index == task.scene : bodies[b].index == region.index;
    if (bodies[b].kind == region.kind && is_it) return b;
  }
  return std::nullopt;
}

}  // namespace probe::plan
