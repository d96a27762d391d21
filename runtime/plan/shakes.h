// How a start moves the cameras of its task.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "runtime/plan/tables.h"

namespace probe::plan {

inline constexpr std::size_t kShakeReals = 7;

struct Shake {
  std::array<double, 3> moved{};             // m, in the frame of the camera's mount
  std::array<double, 4> turned{1, 0, 0, 0};  // unit; about its own ahead, left and up
  bool operator==(const Shake&) const = default;
};

// Of a task's view, by its place among them; `all` are the numbers of an episode.
inline Shake shake_of(std::span<const double> all, std::size_t view) {
  Shake shake;
  if (all.empty()) return shake;
  const double* at = all.data() + view * kShakeReals;
  for (std::size_t i = 0; i < 3; ++i) shake.moved[i] = at[i];
  for (std::size_t i = 0; i < 4; ++i) shake.turned[i] = at[3 + i];
  return shake;
}

inline std::span<const double> shakes_of(const Tables& tables, const EpisodeRecord& episode) {
  return slice_of(tables.reals, episode.shaken);
}

}  // namespace probe::plan
