#include "runtime/assets/hollow.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "runtime/base/trig.h"

namespace probe::assets {
namespace {

using Points = std::vector<Vec3>;

constexpr int kSectors = 16, kSlices = 4;
constexpr int kGrid = 48;           // columns a side in which the inside is looked for
constexpr double kThinnest = 2e-4;  // m, as hulls have it

struct HalfSpace {
  Vec3 normal = Vec3::Zero();
  double offset = 0;  // inside: normal . p <= offset
};

// Sutherland and Hodgman, "Reentrant polygon clipping", 1974.
Points clipped(const Points& polygon, const HalfSpace& by) {
  Points out;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double da = by.normal.dot(a) - by.offset, db = by.normal.dot(b) - by.offset;
    if (da <= 0) out.push_back(a);
    if ((da < 0 && db > 0) || (da > 0 && db < 0)) out.push_back(a + (b - a) * (da / (da - db)));
  }
  return out;
}

// Corners of what is left of the surface within all of `cell`.
Points within(const scene::TriangleSoup& surface, std::span<const HalfSpace> cell) {
  Points out;
  for (std::size_t i = 0; i + 2 < surface.indices.size(); i += 3) {
    Points polygon;
    for (std::size_t k = 0; k < 3; ++k)
      polygon.push_back(surface.vertices[surface.indices[i + k]]);
    for (const HalfSpace& side : cell) {
      polygon = clipped(polygon, side);
      if (polygon.empty()) break;
    }
    out.insert(out.end(), polygon.begin(), polygon.end());
  }
  return out;
}

// Where a plumb line from above first meets the surface; nothing beside it.
double top_at(const scene::TriangleSoup& surface, double x, double y) {
  double top = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i + 2 < surface.indices.size(); i += 3) {
    const Vec3 &a = surface.vertices[surface.indices[i]],
               &b = surface.vertices[surface.indices[i + 1]],
               &c = surface.vertices[surface.indices[i + 2]];
    const double area = (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
    if (area == 0) continue;
    const double u = ((x - a.x()) * (c.y() - a.y()) - (y - a.y()) * (c.x() - a.x())) / area;
    const double v = ((b.x() - a.x()) * (y - a.y()) - (b.y() - a.y()) * (x - a.x())) / area;
    if (u < 0 || v < 0 || u + v > 1) continue;
    top = std::max(top, a.z() + u * (b.z() - a.z()) + v * (c.z() - a.z()));
  }
  return top;
}

struct Inside {
  double x = 0, y = 0;   // its middle
  double floor = 0;      // its lowest point
  std::size_t columns = 0;
};

// Columns whose top lies in the lower half of the thing, away from its outline.
Inside find_inside(const scene::TriangleSoup& surface, const Vec3& low, const Vec3& high) {
  Inside out;
  out.floor = high.z();
  const double half = low.z() + (high.z() - low.z()) / 2;
  for (int i = 0; i < kGrid; ++i) {
    for (int k = 0; k < kGrid; ++k) {
      const double x = low.x() + (high.x() - low.x()) * (i + 0.5) / kGrid;
      const double y = low.y() + (high.y() - low.y()) * (k + 0.5) / kGrid;
      const double top = top_at(surface, x, y);
      if (!(top < half) || !std::isfinite(top)) continue;
      ++out.columns;
      out.x += x;
      out.y += y;
      out.floor = std::min(out.floor, top);
    }
  }
  if (out.columns > 0) {
    out.x /= static_cast<double>(out.columns);
    out.y /= static_cast<double>(out.columns);
  }
  return out;
}

// Nothing where less than a solid is left.
std::optional<scene::HullPart> piece_of(const scene::TriangleSoup& surface,
                                        std::span<const HalfSpace> cell, const std::string& name) {
  const Points points = within(surface, cell);
  if (points.size() < 4) return std::nullopt;
  Vec3 low = points.front(), high = low;
  for (const Vec3& p : points) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  if ((high - low).minCoeff() < kThinnest) return std::nullopt;
  auto hull = scene::make_hull(points, name, 32);
  if (!hull) return std::nullopt;
  return std::move(hull).value();
}

}  // namespace

void add_triangles(const scene::ConvexPart& part, const Vec3& centre, scene::TriangleSoup& to) {
  const auto first = static_cast<std::uint32_t>(to.vertices.size());
  for (const Vec3& p : part.vertices) to.vertices.push_back(p + centre);
  for (const scene::ConvexPart::Face& face : part.faces) {
    for (std::size_t k = 1; k + 1 < face.loop.size(); ++k) {
      to.indices.insert(to.indices.end(),
                        {first + face.loop[0], first + face.loop[k], first + face.loop[k + 1]});
    }
  }
}

double enclosed_volume(const scene::TriangleSoup& surface) {
  double six = 0;
  for (std::size_t i = 0; i + 2 < surface.indices.size(); i += 3) {
    six += surface.vertices[surface.indices[i]].dot(
        surface.vertices[surface.indices[i + 1]].cross(surface.vertices[surface.indices[i + 2]]));
  }
  return six / 6;
}

Result<scene::TriangleSoup> split_hollow(const scene::TriangleSoup& surface,
                                         const std::string& name) {
  scene::TriangleSoup out;
  if (surface.indices.empty()) return Failure{Fault::kAsset, "no triangle", name};
  Vec3 low = surface.vertices[surface.indices.front()], high = low;
  for (const std::uint32_t i : surface.indices) {
    low = low.cwiseMin(surface.vertices[i]);
    high = high.cwiseMax(surface.vertices[i]);
  }
  const Inside inside = find_inside(surface, low, high);
  constexpr std::size_t kFewest = 4;  // columns, of kGrid * kGrid
  if (inside.columns < kFewest) {
    return Failure{Fault::kAsset, "nothing in it is open upwards: it has no inside to keep free",
                   name};
  }
  const auto add = [&](const std::optional<scene::HullPart>& piece) {
    if (piece) add_triangles(piece->part, Vec3::Zero(), out);
  };
  const HalfSpace below{Vec3::UnitZ(), inside.floor};
  add(piece_of(surface, {&below, 1}, name));
  // A hair above the floor: what lies in the plane of the cut is the floor's, and reaches the middle.
  const double foot = inside.floor + 1e-5;
  const auto height = [&](int at) { return foot + (high.z() - foot) * at / kSlices; };
  for (int i = 0; i < kSectors; ++i) {
    const auto side = [&](int k, double sign) {
      const SinCos turn = portable_sincos_deg(360.0 * k / kSectors);
      const Vec3 normal(sign * turn.sin, -sign * turn.cos, 0);
      return HalfSpace{normal, normal.x() * inside.x + normal.y() * inside.y};
    };
    const HalfSpace cell[] = {side(i, 1), side(i + 1, -1), {-Vec3::UnitZ(), -foot}};
    const auto whole = piece_of(surface, cell, name);
    std::vector<std::optional<scene::HullPart>> slices;
    double sum = 0;
    for (int k = 0; k < kSlices; ++k) {
      const HalfSpace slice[] = {cell[0], cell[1], {-Vec3::UnitZ(), -height(k)},
                                 {Vec3::UnitZ(), height(k + 1)}};
      slices.push_back(piece_of(surface, slice, name));
      if (slices.back()) sum += slices.back()->volume;
    }
    // Where slices are too thin to be solid the sector is.
    if (whole && (whole->volume <= 1.1 * sum || sum == 0)) {
      add(whole);
    } else {
      for (const auto& slice : slices) add(slice);
    }
  }
  if (out.indices.empty()) return Failure{Fault::kAsset, "nothing solid is left of it", name};
  return out;
}

}  // namespace probe::assets
