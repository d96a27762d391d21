#include "runtime/plan/places.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "runtime/plan/roles.h"

namespace probe::plan {

Place place_at(double x, double y) {
  constexpr double kPerMetre = 1e6;
  return {std::llround(x * kPerMetre), std::llround(y * kPerMetre)};
}

namespace {

std::string key_of(const Plan& plan, const TaskRecord& task, const EpisodeRecord& episode,
                   const std::vector<Place>& places) {
  std::string key = fmt::format("{} {}", plan.text(plan.scenes()[task.scene].name), episode.index);
  for (const Place& place : places) key += fmt::format(" {} {}", place[0], place[1]);
  return key;
}

std::vector<Place> places_of(std::span<const PlacementRecord> bodies) {
  std::vector<Place> places;
  for (const PlacementRecord& body : bodies)
    places.push_back(place_at(body.position[0], body.position[1]));
  return places;
}

}  // namespace

std::string place_key(const Plan& plan, const TaskRecord& task, const EpisodeRecord& episode) {
  const std::size_t in_roles = roles_of(plan.tables(), task).distractors.first;
  const auto bodies = plan.placements(episode);
  return key_of(plan, task, episode, places_of(bodies.first(std::min(in_roles, bodies.size()))));
}

std::string taken_key(const Plan& plan, const TaskRecord& task, const EpisodeRecord& episode) {
  const Slice distractors = roles_of(plan.tables(), task).distractors;
  std::vector<Place> places = places_of(plan.placements(episode));
  const auto at = [&](std::size_t body) {
    return places.begin() + static_cast<std::ptrdiff_t>(std::min(body, places.size()));
  };
  places.erase(at(distractors.first), at(distractors.first + distractors.count));
  std::sort(places.begin(), places.end());
  return key_of(plan, task, episode, places);
}

}  // namespace probe::plan
