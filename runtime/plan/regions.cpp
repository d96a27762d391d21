#include "runtime/plan/regions.h"

#include <algorithm>
#include <cmath>

namespace probe::plan {
namespace {

// Surface and what stands are one each in a scene, whose number their regions have.
bool is_of_scene(const RegionRecord& region) {
  return region.kind == static_cast<std::uint32_t>(BodyKind::kSurface) ||
         region.kind == static_cast<std::uint32_t>(BodyKind::kFixture);
}

}  // namespace

std::array<std::array<double, 3>, 3> axes_of(const TurnedBox& box) {
  const auto& [w, x, y, z] = box.rotation;
  std::array<std::array<double, 3>, 3> rows{
      {{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)},
       {2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)},
       {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)}}};
  // The square root of a half is not exact.
  constexpr double kRounding = 1e-15;
  for (auto& row : rows) {
    for (double& value : row) {
      if (std::abs(value - std::round(value)) <= kRounding) value = std::round(value) + 0.0;
    }
  }
  return rows;
}

void box_around(const TurnedBox& box, std::array<double, 3>& low, std::array<double, 3>& high) {
  const auto rows = axes_of(box);
  for (std::size_t i = 0; i < 3; ++i) {
    const double reach = std::abs(rows[i][0]) * box.half[0] + std::abs(rows[i][1]) * box.half[1] +
                         std::abs(rows[i][2]) * box.half[2];
    low[i] = box.middle[i] - reach;
    high[i] = box.middle[i] + reach;
  }
}

std::optional<TurnedBox> turned_box(const Tables& tables, std::uint32_t region) {
  const auto at = std::ranges::lower_bound(tables.turned, region, {}, &TurnedRecord::region);
  if (at == tables.turned.end() || at->region != region) return std::nullopt;
  return at->box();
}

TurnedBox box_of(const std::array<double, 3>& low, const std::array<double, 3>& high,
                 const std::optional<TurnedBox>& turned) {
  if (turned) return *turned;
  TurnedBox box;
  for (std::size_t i = 0; i < 3; ++i) {
    box.middle[i] = (low[i] + high[i]) / 2;
    box.half[i] = (high[i] - low[i]) / 2;
  }
  return box;
}

TurnedBox box_of(const Tables& tables, std::uint32_t region) {
  const RegionRecord& record = tables.regions[region];
  return box_of(record.low, record.high, turned_box(tables, region));
}

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
