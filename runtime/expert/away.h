// Tasks that ask for the source to be anywhere but on the target: a free spot on the surface, which
// then stands in for the target (put_spot.h).
#pragma once

#include <optional>

#include "runtime/expert/reach.h"
#include "runtime/expert/waypoints.h"

namespace probe::expert {

// Where on the surface the source shall go: far from the target and from everything else, at least
// 10 cm from where it is. The roomiest that the arm reaches; nullopt if there is none.
std::optional<Vec2> find_spot(const Scene& scene, const Reach& reach);

}  // namespace probe::expert
