// Where in a region, on a part, beside an object or on the surface a source is put: a spot with
// room for it and for the hand. The spot stands in for the target.
#pragma once

#include <optional>

#include "runtime/expert/reach.h"
#include "runtime/expert/waypoints.h"

namespace probe::expert {

struct PutSpot {
  int object = -1, fixture = -1;  // whose frame; none: the base's
  Vec3 at = Vec3::Zero();         // on what the source shall stand
};

// Whether a put goes to a spot; else to an object's middle, as a target does.
bool goes_to_spot(const policy::Skill& skill);

// The roomiest near the middle; nothing where there is none that the arm reaches. `scene` sees the
// source of the skill.
std::optional<PutSpot> find_put_spot(const Scene& scene, const policy::Privileged& view,
                                     const policy::Skill& skill, const Reach& reach);

// In the base frame, now.
Vec3 spot_now(const PutSpot& spot, const policy::Privileged& view);

// The scene as if the spot were the target; what was the target is one of the others.
Scene with_target_at(Scene scene, const Vec3& spot);

}  // namespace probe::expert
