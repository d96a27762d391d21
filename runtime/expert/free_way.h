// Ways of the hand through what stands about: straight, or up, over and down.
#pragma once

#include <optional>
#include <span>
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

// Whether it goes so along all of a way.
bool is_free_along(const FreeLine& line, const Pose& from, std::span<const Pose> way);

// Whether fingers that turn have to be as open as `open` before the hand goes: as they are now it
// would come near something on this way. Those that slide never.
bool is_set_first(const Surroundings& around, const Pose& from, std::span<const Pose> way,
                  const robot::HandShape& hand, double openness, double open);

// Whether they are as open as they were told, or had the decisions that it takes them at most.
bool are_set(double openness, double open, int decisions);

// The corners of the shortest of these ways, the last is `to`. Nothing where all touch something.
std::optional<std::vector<Pose>> free_way(const Surroundings& around, const Pose& from,
                                          const Pose& to, std::span<const Ball> balls);

}  // namespace probe::expert
