#include "runtime/expert/solid_top.h"

#include <algorithm>
#include <cmath>

namespace probe::expert {
namespace {

constexpr double kFlat = 1e-12;  // m^2: a triangle that stands upright
constexpr double kEdge = -1e-9;  // of a weight: on the edge is over it

}  // namespace

std::optional<double> top_over(std::span<const Vec3> vertices, const Vec2& at) {
  std::optional<double> out;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    for (std::size_t j = i + 1; j < vertices.size(); ++j) {
      const Vec2 b = (vertices[j] - vertices[i]).head<2>();
      for (std::size_t k = j + 1; k < vertices.size(); ++k) {
        const Vec2 c = (vertices[k] - vertices[i]).head<2>();
        const Vec2 p = at - vertices[i].head<2>();
        const double area = b.x() * c.y() - b.y() * c.x();
        if (std::abs(area) < kFlat) continue;
        const double v = (p.x() * c.y() - p.y() * c.x()) / area;
        const double w = (b.x() * p.y() - b.y() * p.x()) / area;
        if (v < kEdge || w < kEdge || v + w > 1 - kEdge) continue;
        const double z = (1 - v - w) * vertices[i].z() + v * vertices[j].z() + w * vertices[k].z();
        out = std::max(out.value_or(z), z);
      }
    }
  }
  return out;
}

}  // namespace probe::expert
