#include "runtime/plan/places.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "runtime/plan/roles.h"

namespace probe::plan {

Place place_at(double x, double y) {
  constexpr double kPerMetre = 1e6;
  return {std::llround(x * kPerMetre), std::llround(y * kPerMetre)};
}

std::string place_key(const Plan& plan, const TaskRecord& task, const EpisodeRecord& episode) {
  const std::size_t moved = roles_of(plan.tables(), task).distractors.first;  // all in roles
  std::string key = fmt::format("{} {}", plan.text(plan.scenes()[task.scene].name), episode.index);
  const auto placements = plan.placements(episode);
  for (const PlacementRecord& body : placements.first(std::min(moved, placements.size()))) {
    const Place place = place_at(body.position[0], body.position[1]);
    key += fmt::format(" {} {}", place[0], place[1]);
  }
  return key;
}

}  // namespace probe::plan
