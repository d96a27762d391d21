#include "assets/make/shapes.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "runtime/base/check.h"
#include "runtime/base/trig.h"

namespace probe::make {
namespace {

Vec3 centre_of(const std::vector<Vec3>& loop) {
  Vec3 sum = Vec3::Zero();
  for (const Vec3& p : loop) sum += p;
  return sum / static_cast<double>(loop.size());
}

// Loops round a path, each in the plane across it, and a point at both ends unless it is a ring.
// The frame is carried along, so that the tube does not twist.
std::vector<std::vector<Vec3>> tube_rows(std::span<const Vec3> path, std::span<const double> radii,
                                         int corners, bool ring) {
  const std::size_t n = path.size();
  std::vector<std::vector<Vec3>> rows;
  Vec3 aside = Vec3::Zero();
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3& before = path[i > 0 ? i - 1 : (ring ? n - 1 : 0)];
    const Vec3& after = path[i + 1 < n ? i + 1 : (ring ? 0 : n - 1)];
    const Vec3 along = (after - before).normalized();
    if (i == 0) aside = std::abs(along.z()) < 0.8 ? Vec3::UnitZ() : Vec3::UnitX();
    aside = (aside - along * along.dot(aside)).normalized();
    const Vec3 other = along.cross(aside);
    // Where the path bends, the cut is oblique: wider by the cosine of half the angle.
    const Vec3 in = (path[i] - before), out = (after - path[i]);
    double widen = 1;
    if (in.norm() > 0 && out.norm() > 0) {
      widen = 1 / std::sqrt(std::max(0.3, (1 + in.normalized().dot(out.normalized())) / 2));
    }
    std::vector<Vec3> loop;
    for (int c = 0; c < corners; ++c) {
      const SinCos a = portable_sincos_deg(-360.0 * c / corners);
      const double radius = radii[i] * widen;
      loop.push_back(path[i] + radius * (a.cos * aside + a.sin * other));
    }
    const std::vector<Vec3> point(static_cast<std::size_t>(corners), path[i]);
    if (!ring && i == 0) rows.push_back(point);
    rows.push_back(std::move(loop));
    if (!ring && i + 1 == n) rows.push_back(point);
  }
  if (ring) rows.push_back(rows.front());
  return rows;
}

}  // namespace

Vec2 around_and_along(const SheetPlace& at) { return {at.around, at.along}; }

Mapping seen_from_above(const Vec2& size) {
  return [size](const SheetPlace& at) {
    return Vec2(0.5 + at.point.x() / size.x(), 0.5 - at.point.y() / size.y());
  };
}

Surface skin(const std::vector<std::vector<Vec3>>& rows, bool closed, const Mapping& uv) {
  Grid grid{.rows = static_cast<int>(rows.size()),
            .columns = static_cast<int>(rows.front().size()),
            .closed = closed,
            .points = {},
            .uv = {}};
  std::vector<double> way(rows.size(), 0.0);
  for (std::size_t r = 1; r < rows.size(); ++r) {
    PROBE_CHECK(rows[r].size() == rows[0].size(), "loops of a skin have equally many points");
    way[r] = way[r - 1] + std::max((centre_of(rows[r]) - centre_of(rows[r - 1])).norm(),
                                   (rows[r][0] - rows[r - 1][0]).norm());
  }
  const int uv_columns = closed ? grid.columns + 1 : grid.columns;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    grid.points.insert(grid.points.end(), rows[r].begin(), rows[r].end());
    for (int c = 0; c < uv_columns; ++c) {
      grid.uv.push_back(uv({.point = rows[r][static_cast<std::size_t>(c % grid.columns)],
                            .around = static_cast<double>(c) / (uv_columns - 1),
                            .along = way[r] / way.back()}));
    }
  }
  Surface surface;
  add_grid(surface, grid);
  return surface;
}

Surface lathe(std::span<const Vec2> profile, int columns, const Mapping& uv) {
  std::vector<std::vector<Vec3>> rows;
  for (const Vec2& at : profile) rows.push_back(circle(at.x(), columns, at.y()));
  return skin(rows, true, uv);
}

std::vector<Vec3> circle(double radius, int corners, double z, double phase_deg) {
  std::vector<Vec3> loop;
  for (int i = 0; i < corners; ++i) {
    const SinCos a = portable_sincos_deg(phase_deg + 360.0 * i / corners);
    loop.emplace_back(radius * a.cos, radius * a.sin, z);
  }
  return loop;
}

std::vector<Vec3> outline(const RoundedRectangle& shape, double z) {
  constexpr std::array<std::array<int, 2>, 4> kCorners{{{1, 1}, {-1, 1}, {-1, -1}, {1, -1}}};
  std::vector<Vec3> loop;
  for (std::size_t corner = 0; corner < 4; ++corner) {
    for (int i = 0; i <= shape.steps; ++i) {
      const SinCos a = portable_sincos_deg(
          90.0 * (static_cast<double>(corner) + static_cast<double>(i) / shape.steps));
      loop.emplace_back(
          kCorners[corner][0] * (shape.half.x() - shape.radius) + shape.radius * a.cos,
          kCorners[corner][1] * (shape.half.y() - shape.radius) + shape.radius * a.sin, z);
    }
    const auto next = kCorners[(corner + 1) % 4];
    const bool along_x = corner % 2 == 0;
    const Vec3 from = loop.back();
    const Vec3 to = along_x ? Vec3(next[0] * (shape.half.x() - shape.radius), from.y(), z)
                            : Vec3(from.x(), next[1] * (shape.half.y() - shape.radius), z);
    for (int i = 1; i < shape.side_steps; ++i) {
      loop.push_back(from + (to - from) * (static_cast<double>(i) / shape.side_steps));
    }
  }
  return loop;
}

Surface cushion(const Cushion& shape, const Mapping& uv) {
  std::vector<std::vector<Vec3>> rows;
  const auto add = [&](double inset, double z) {
    const Vec2 half(shape.half.x() - inset, shape.half.y() - inset);
    const double radius = std::max(shape.corner - inset, 0.02 * shape.corner);
    rows.push_back(outline({.half = half,
                            .radius = radius,
                            .steps = shape.corner_steps,
                            .side_steps = shape.side_steps},
                           z));
  };
  const double middle = std::min(shape.half.x(), shape.half.y());
  const auto add_cap = [&](int ring, double z) {
    add(shape.rim + (middle - shape.rim) * (1 - static_cast<double>(ring) / shape.rings), z);
  };
  for (int ring = 0; ring < shape.rings; ++ring) add_cap(ring, shape.half.z());
  for (int side : {1, -1}) {
    for (int i = 0; i <= shape.rim_steps; ++i) {
      const int step = side > 0 ? i : shape.rim_steps - i;
      const SinCos a = portable_sincos_deg(90.0 * step / shape.rim_steps);
      add(shape.rim * (1 - a.sin), side * (shape.half.z() - shape.rim * (1 - a.cos)));
    }
  }
  for (int ring = shape.rings - 1; ring >= 0; --ring) add_cap(ring, -shape.half.z());
  return skin(rows, true, uv);
}

Surface rod(const Rod& rod) {
  const std::vector<double> radii(rod.path.size(), rod.radius);
  return skin(tube_rows(rod.path, radii, rod.corners, rod.ring), true, around_and_along);
}

Surface tapered_rod(std::span<const Vec3> path, std::span<const double> radii, int corners) {
  return skin(tube_rows(path, radii, corners, false), true, around_and_along);
}

Surface sheet(const Vec3& origin, const Vec3& a, const Vec3& b, const Vec2& repeat) {
  Surface surface;
  add_grid(surface, {.rows = 2,
                     .columns = 2,
                     .closed = false,
                     .points = {origin, origin + b, origin + a, origin + a + b},
                     .uv = {{0, 0}, {0, repeat.y()}, {repeat.x(), 0}, {repeat.x(), repeat.y()}}});
  return surface;
}

void append(Surface& surface, const Surface& more) {
  surface.insert(surface.end(), more.begin(), more.end());
}

void move_points(Surface& surface, const std::function<Vec3(const Vec3&)>& to) {
  for (Triangle& t : surface) {
    for (Vec3& p : t.position) p = to(p);
  }
}

void lay_along(Surface& surface, int axis) {
  move_points(surface, [axis](const Vec3& p) {
    return axis == 0 ? Vec3(p.z(), p.x(), p.y()) : Vec3(p.y(), p.z(), p.x());
  });
}

void fit_to_box(std::span<Surface* const> surfaces, const Box& box) {
  Box all = bounds(*surfaces[0]);
  for (const Surface* surface : surfaces) {
    const Box one = bounds(*surface);
    all.low = all.low.cwiseMin(one.low);
    all.high = all.high.cwiseMax(one.high);
  }
  const Vec3 scale = (box.high - box.low).cwiseQuotient(all.high - all.low);
  for (Surface* surface : surfaces) {
    move_points(*surface,
                [&](const Vec3& p) -> Vec3 { return box.low + (p - all.low).cwiseProduct(scale); });
  }
}

Surface in_metres(Surface millimetres) {
  move_points(millimetres, [](const Vec3& p) { return Vec3(p / 1000); });
  return millimetres;
}

Box box_of(const Vec3& size, const Vec3& centre) {
  return {(centre - size / 2) / 1000, (centre + size / 2) / 1000};
}

void add_octagon(std::vector<Vec3>& points, const Octagon& shape) {
  const double middle = (shape.bottom + shape.top) / 2, half = (shape.top - shape.bottom) / 2;
  for (const double side : {-1.0, 1.0}) {
    for (const double up : {-1.0, 1.0}) {
      points.emplace_back(shape.x, side * shape.half_width * shape.flat, middle + up * half);
      points.emplace_back(shape.x, side * shape.half_width, middle + up * half * shape.flat);
    }
  }
}

Polyhedron hull_mm(const std::vector<Vec3>& points, std::string name) {
  std::vector<Vec3> metres;
  for (const Vec3& p : points) metres.push_back(p / 1000);
  return convex_hull(metres, std::move(name));
}

void add_ring(std::vector<Polyhedron>& parts, std::span<const Vec2> profile, int segments,
              const std::string& name, const Vec3& centre) {
  for (int i = 0; i < segments; ++i) {
    std::vector<Vec3> points;
    for (const Vec2& at : profile) {
      for (const int corner : {i, i + 1}) {
        const SinCos a = portable_sincos_deg(360.0 * corner / segments);
        points.push_back(centre + Vec3(at.x() * a.cos, at.x() * a.sin, at.y()));
      }
    }
    parts.push_back(hull_mm(points, name + "_" + std::to_string(i)));
  }
}

std::vector<Vec3> flat_sided(double apothem, int corners, double z) {
  const double radius = apothem / portable_sincos_deg(180.0 / corners).cos;
  return circle(radius, corners, z, 180.0 / corners);
}

std::vector<OutputFile> object_files(const std::string& name, const std::vector<Part>& parts,
                                     const std::vector<Polyhedron>& collision) {
  return {{"objects/" + name + "/visual.glb", glb_bytes(name, parts)},
          {"objects/" + name + "/collision.obj", obj_bytes(collision)}};
}

std::vector<OutputFile> baked_files(const std::string& name, const std::vector<Part>& lit,
                                    const std::vector<Polyhedron>& collision) {
  std::vector<Part> parts = lit;
  for (Part& part : parts) {
    Material& material = part.material;
    material.is_baked = true;
    material.roughness = 1;
    if (material.texture) {
      dim(*material.texture, kGainBaked);
    } else {
      for (double& channel : material.base_color) channel *= kGainBaked;
    }
  }
  return object_files(name, parts, collision);
}

Part plain_part(Surface surface, std::string name, const Colour& base_color, double roughness) {
  return {std::move(surface),
          {.name = std::move(name),
           .base_color = base_color,
           .texture = std::nullopt,
           .roughness = roughness}};
}

Part painted_part(Surface surface, std::string name, Image texture, double roughness) {
  return {std::move(surface),
          {.name = std::move(name), .texture = std::move(texture), .roughness = roughness}};
}

}  // namespace probe::make
