// Ways of the hand through what stands about: straight, or up, over and down.
#pragma once

#include <optional>
#include <vector>

#include "runtime/expert/solids.h"

namespace probe::expert {

// Whether the hand goes along a straight line without coming near anything. Near its ends it may be
// as near as it is there.
struct FreeLine {
  const Surroundings* around = nullptr;
  std::span<const Ball> balls;
  double wanted_room = 0.010;  // m of clearance, where the ends have as much
  double step = 0.02;          // m between looks
  bool is_free(const Pose& from, const Pose& to) const;
};

// The corners of the shortest of these ways, the last is `to`. Nothing where all touch something.
std::optional<std::vector<Pose>> free_way(const Surroundings& around, const Pose& from,
                                          const Pose& to, std::span<const Ball> balls);

}  // namespace probe::expert
