// Where the tool lets go: the held source over the middle of the target, turned about the vertical
// or let go from higher where neighbours and walls leave the gripper no room.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "runtime/expert/reach.h"
#include "runtime/expert/waypoints.h"

namespace probe::expert {

struct Place {
  Pose tcp;              // base frame
  double turn = 0;       // rad about the vertical, from the tool's present pose
  double lift = 0;       // m that the source is let go above where it would touch
  double clearance = 0;  // m, of gripper and source from all but the target; up to 1 cm
  double overhang = 0;   // share of the source's outline corners beyond the target's outline
  double openness = 1;   // of the gripper, to let go
  double cost = 0;
};

// Sorted by cost. `tool` holds the source where it is seen now, or will once it is there.
// `on_mark`: the target only marks a spot among other things; the source needs room between them,
// and the gripper may open just a little.
std::vector<Place> place_candidates(const Scene& scene, const Pose& tool, bool on_mark = false);

// The best that the arm reaches from joint positions at which it holds the source.
std::optional<Place> plan_place(const Scene& scene, const Reach& reach,
                                std::span<const double> joints, bool on_mark = false);

// Joint positions up from where the tool is, over to above a place, and down to it; what hangs
// `hang` m below the tool clears what it passes. Nothing where the arm follows no such way.
std::optional<std::vector<JointVector>> way_to_place(const Scene& scene, const Reach& reach,
                                                     std::span<const double> joints, double hang,
                                                     const Pose& place);

}  // namespace probe::expert
