// Where in a region, on a part, beside an object or on the surface a source is put: a spot with
// room for it and for the hand. The spot stands in for the target.
#pragma once

#include <vector>

#include "runtime/expert/reach.h"
#include "runtime/expert/waypoints.h"

namespace probe::expert {

struct PutSpot {
  int object = -1, fixture = -1;  // whose frame; none: the base's
  Vec3 at = Vec3::Zero();         // on what the source shall stand
  double cost = 0;
};

// Whether a put goes to a spot; else to an object's middle, as a target does.
bool goes_to_spot(const policy::Skill& skill);

// Roomy ones near the middle that the arm reaches, best first. `scene` sees the source of the
// skill. `leaves_room`: half way out, as something else shall lie there too.
std::vector<PutSpot> find_put_spots(const Scene& scene, const policy::Privileged& view,
                                    const policy::Skill& skill, const Reach& reach,
                                    bool leaves_room = false);

// A place that is not asked what room there is over it; base frame.
struct PutPlace {
  Vec3 at = Vec3::Zero();  // on what the source shall stand
  double cost = 0;
  double top = 0;          // m, of the region
  std::vector<Vec2> ways;  // level, unit: along its sides
  Outline outline;         // of the region
  // m of the region that are before it, for what comes along `way`.
  double depth_along(const Vec2& way) const;
};

// All of a region's grid that carry what stands there; of what is put beside something, around it.
std::vector<PutPlace> find_put_places(const Scene& scene, const policy::Privileged& view,
                                      const policy::Skill& skill);

// In the base frame, now.
Vec3 spot_now(const PutSpot& spot, const policy::Privileged& view);

// The scene as if the spot were the target; what was the target is one of the others.
Scene with_target_at(Scene scene, const Vec3& spot);

}  // namespace probe::expert
