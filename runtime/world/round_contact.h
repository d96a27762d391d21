// Where a ball or capsule touches another convex part: exact distances, so that round things roll
// without corners. Pure geometry of one instant.
#pragma once

#include "runtime/world/hull_contact.h"

namespace probe::world {

// At least one of the parts has `round` above 0. Fills `out` with at most three points, each with
// its own normal (count 0: nothing nearer than the margin).
void collide_rounded(const scene::ConvexPart& a, const scene::ConvexPart& b,
                     const RelativePose& b_in_a, double margin, Candidates* out);

}  // namespace probe::world
