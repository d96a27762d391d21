// How high a convex solid reaches over a point: what stands on a slope stands on this, not on the
// solid's highest vertex.
#pragma once

#include <optional>
#include <span>

#include "runtime/expert/footprint.h"

namespace probe::expert {

// The highest point of the hull of `vertices` over `at`; nothing where `at` is beside it. Tries all
// triangles, which is for shapes of few vertices.
std::optional<double> top_over(std::span<const Vec3> vertices, const Vec2& at);

}  // namespace probe::expert
