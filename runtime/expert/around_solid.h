// Where two fingers fit around a convex solid, from whatever direction the hand comes: what holds
// of handles and holds of objects have in common.
#pragma once

#include <span>
#include <vector>

#include "runtime/expert/solids.h"
#include "runtime/robot/robot.h"

namespace probe::expert {

struct FingersAround {
  Vec3 at;           // of the tool centre point
  Vec3 down;         // where the hand points
  Vec3 closing;      // the line that the fingers close along
  double half = 0;   // m, of what is between them
  double share = 0;  // beside its middle, of the room that there is
};

// Ways for the hand to come to something that stands so: from above, from its sides, and between.
std::vector<Vec3> ways_to(const Pose& pose);

// All of these ways to a solid of a body at `pose`. `upright`: the most that a closing line may lie
// along the way down, as a cosine.
std::vector<FingersAround> fingers_around(const Solid& solid, const Pose& pose,
                                          std::span<const Vec3> ways, const robot::HandShape& hand,
                                          double upright);

// The tool's turn, x down, the fingers along y.
Quat tool_frame(const Vec3& down, const Vec3& closing);

// m from a point in a solid to its box's face in a direction; the base frame.
double way_out(const Solid& solid, const Pose& pose, const Vec3& from, const Vec3& direction);

}  // namespace probe::expert
