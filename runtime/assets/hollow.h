// A thing that is open upwards, as convex parts that leave its inside free.
#pragma once

#include <string>

#include "runtime/base/result.h"
#include "runtime/scene/hull.h"

namespace probe::assets {

// In: the closed surface of a cup, bowl or tray, metres, z up. Out: the hulls of what a knife leaves
// of it that cuts below the floor of its inside, along the middle of it into sectors, and each
// sector into slices where one hull would fill the inside by more than a tenth of itself. Fails
// (kAsset) where nothing is open upwards and closed below.
Result<scene::TriangleSoup> split_hollow(const scene::TriangleSoup& surface, const std::string& name);

// The faces of a hull behind the triangles that are there, with corners of its own; its corners are
// about `centre`.
void add_triangles(const scene::ConvexPart& part, const Vec3& centre, scene::TriangleSoup& to);

// Cubic metres within a closed surface whose triangles wind outwards, 0 or less where they do not.
double enclosed_volume(const scene::TriangleSoup& surface);

}  // namespace probe::assets
