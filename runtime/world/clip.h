// Faces that lie on each other: the incident polygon cut by the sides of the reference face.
#pragma once

#include "runtime/world/hull_contact.h"

namespace probe::world {

// Points of the other hull's faces nearer than the margin to the reference face, inside its sides.
void clip_faces(const scene::ConvexPart& a, const scene::ConvexPart& b, const RelativePose& b_in_a,
                const FaceRef& reference, double margin, Candidates* out);

}  // namespace probe::world
