// For what cannot be gripped: where to put the fingers and how far to push, so that the source
// moves and nothing else does.
#pragma once

#include <optional>

#include "runtime/expert/reach.h"
#include "runtime/expert/waypoints.h"

namespace probe::expert {

struct Shove {
  Pick start;          // the tool at the source, fingers around a wall of it or beside it
  Pose end;            // of the tool
  bool closed = true;  // fingers
};

// The way with the most room that the arm can follow; nothing if there is none.
std::optional<Shove> plan_shove(const Scene& scene, const Reach& reach);

}  // namespace probe::expert
