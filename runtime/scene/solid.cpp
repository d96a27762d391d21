#include "runtime/scene/solid.h"

#include <algorithm>
#include <cmath>

namespace probe::scene {

Solid upright_solid(const Vec3& low, const Vec3& high) {
  const Vec3 half = (high - low) / 2;
  return {(low + high) / 2, {Vec3(half.x(), 0, 0), Vec3(0, half.y(), 0), Vec3(0, 0, half.z())}};
}

Solid moved(const Solid& solid, const Pose& frame) {
  Solid out;
  out.centre = frame.apply(solid.centre);
  for (std::size_t i = 0; i < 3; ++i) out.axes[i] = frame.rotation * solid.axes[i];
  return out;
}

Vec3 Solid::half_extent() const {
  return axes[0].cwiseAbs() + axes[1].cwiseAbs() + axes[2].cwiseAbs();
}

double overlap(const Solid& a, const Solid& b) {
  const Vec3 between = b.centre - a.centre;
  double least = 1e9;
  const auto along = [&](const Vec3& direction) {
    const double length = direction.norm();
    if (length < 1e-12) return;  // parallel edges: the faces have said it
    double reach = 0;
    for (std::size_t i = 0; i < 3; ++i)
      reach += std::abs(a.axes[i].dot(direction)) + std::abs(b.axes[i].dot(direction));
    least = std::min(least, (reach - std::abs(between.dot(direction))) / length);
  };
  for (std::size_t i = 0; i < 3; ++i) {
    // A face's normal is its edges' product, which a flat box has too.
    for (const Solid* box : {&a, &b}) along(box->axes[i].cross(box->axes[(i + 1) % 3]));
    for (std::size_t j = 0; j < 3; ++j) along(a.axes[i].cross(b.axes[j]));
  }
  return least;
}

}  // namespace probe::scene
