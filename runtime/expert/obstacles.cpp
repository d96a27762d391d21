// Distance to a convex outline in the plane and to a slab in height, put together.
#include "runtime/expert/obstacles.h"

#include <algorithm>
#include <limits>

namespace probe::expert {
namespace {

struct PlaneDistance {
  double value = -std::numeric_limits<double>::infinity();
  Vec2 gradient = Vec2::UnitX();
};

PlaneDistance distance_to(const Outline& outline, const Vec2& point) {
  PlaneDistance inside;
  double nearest = std::numeric_limits<double>::infinity();
  Vec2 away = Vec2::Zero();
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Vec2 &a = outline[i], &b = outline[(i + 1) % outline.size()];
    const Vec2 edge = b - a, off = point - a;
    const double length2 = edge.squaredNorm();
    if (length2 < 1e-16) continue;
    const Vec2 normal = Vec2(edge.y(), -edge.x()) / std::sqrt(length2);
    if (const double d = normal.dot(off); d > inside.value) inside = {d, normal};
    const Vec2 from = off - std::clamp(off.dot(edge) / length2, 0.0, 1.0) * edge;
    if (const double d = from.squaredNorm(); d < nearest) {
      nearest = d;
      away = from;
    }
  }
  if (inside.value <= 0 || nearest < 1e-20) return inside;
  const double d = std::sqrt(nearest);
  return {d, away / d};
}

}  // namespace

Prism make_prism(const Outline& outline, double bottom, double top) {
  Prism prism{outline, bottom, top, Vec2::Zero(), 0};
  Vec2 low = outline.front(), high = low;
  for (const Vec2& p : outline) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  prism.center = 0.5 * (low + high);
  for (const Vec2& p : outline) prism.radius = std::max(prism.radius, (p - prism.center).norm());
  return prism;
}

Distance distance_to(const Prism& prism, const Vec3& point) {
  const PlaneDistance flat = distance_to(prism.outline, point.head<2>());
  const double above = point.z() - prism.top, below = prism.bottom - point.z();
  const double high = std::max(above, below);
  const double up = above >= below ? 1 : -1;
  if (flat.value > 0 && high > 0) {
    const double d = std::sqrt(flat.value * flat.value + high * high);
    return {d, Vec3(flat.value * flat.gradient.x(), flat.value * flat.gradient.y(), high * up) / d};
  }
  if (flat.value > high) return {flat.value, {flat.gradient.x(), flat.gradient.y(), 0}};
  return {high, {0, 0, up}};
}

Distance Obstacles::nearest(const Vec3& point, double beyond) const {
  Distance out{beyond, Vec3::UnitZ()};
  if (point.z() - floor < out.value) out.value = point.z() - floor;
  for (const Prism& prism : prisms) {
    if (point.z() - prism.top > out.value || prism.bottom - point.z() > out.value) continue;
    const double reach = prism.radius + out.value;
    if (reach < 0 || (point.head<2>() - prism.center).squaredNorm() > reach * reach) continue;
    const Distance d = distance_to(prism, point);
    if (d.value < out.value) out = d;
  }
  return out;
}

}  // namespace probe::expert
