#include "assets/make/solid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>

#include "runtime/base/check.h"
#include "runtime/base/trig.h"

namespace probe::make {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kTolerance = 1e-7;  // metres: points this near a plane lie in it

struct Plane {
  Vec3 normal;
  double offset;
};

// The plane through three points if all points lie on one side of it, pointing away from them.
bool supporting_plane(std::span<const Vec3> points, std::array<std::size_t, 3> at, Plane& plane) {
  const Vec3 cross = (points[at[1]] - points[at[0]]).cross(points[at[2]] - points[at[0]]);
  const double length = std::sqrt(cross.squaredNorm());
  if (length < 1e-10) return false;
  plane.normal = cross / length;
  plane.offset = plane.normal.dot(points[at[0]]);
  bool above = false, below = false;
  for (const Vec3& point : points) {
    const double side = plane.normal.dot(point) - plane.offset;
    above = above || side > kTolerance;
    below = below || side < -kTolerance;
    if (above && below) return false;
  }
  if (above) plane = {-plane.normal, -plane.offset};
  return above != below;
}

// The corners of a facet in order: the hull in the plane of the points that lie in it, by Andrew's
// monotone chain.
std::vector<int> facet_loop(std::span<const Vec3> points, const Plane& plane) {
  struct Member {
    Vec2 at;
    int index;
  };
  const Vec3 aside = std::abs(plane.normal.x()) < 0.57 ? Vec3::UnitX() : Vec3::UnitY();
  const Vec3 right = aside.cross(plane.normal).normalized();
  const Vec3 up = plane.normal.cross(right);
  std::vector<Member> members;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (plane.normal.dot(points[i]) < plane.offset - kTolerance) continue;
    members.push_back({{points[i].dot(right), points[i].dot(up)}, static_cast<int>(i)});
  }
  // Left to right; coordinates within the tolerance are equal, or rounding would order a vertical
  // side.
  std::sort(members.begin(), members.end(), [](const Member& a, const Member& b) {
    const auto cell = [](double x) { return std::floor(x / kTolerance + 0.5); };
    return std::array{cell(a.at.x()), cell(a.at.y())} < std::array{cell(b.at.x()), cell(b.at.y())};
  });
  // True if b lies to the right of, or nearly on, the line from a to c: no corner of a chain that
  // turns left.
  const auto is_no_corner = [](const Vec2& a, const Vec2& b, const Vec2& c) {
    const Vec2 along = c - a, to = b - a;
    return to.x() * along.y() - to.y() * along.x() <= kTolerance * along.norm();
  };
  std::vector<Member> chain;
  const auto extend = [&](const Member& next, std::size_t keep) {
    while (chain.size() >= keep + 2 &&
           is_no_corner(chain[chain.size() - 2].at, chain.back().at, next.at)) {
      chain.pop_back();
    }
    chain.push_back(next);
  };
  for (const Member& member : members) extend(member, 0);
  const std::size_t lower = chain.size() - 1;
  for (auto member = members.rbegin() + 1; member != members.rend(); ++member)
    extend(*member, lower);
  chain.pop_back();
  std::vector<int> loop;
  for (const Member& member : chain) loop.push_back(member.index);
  return loop;
}

using Key = std::array<std::int64_t, 3>;

Key position_key(const Vec3& p) {
  const auto cell = [](double x) { return static_cast<std::int64_t>(std::floor(x * 1e7 + 0.5)); };
  return {cell(p.x()), cell(p.y()), cell(p.z())};
}

Vec3 face_normal(const Triangle& t) {
  return (t.position[1] - t.position[0]).cross(t.position[2] - t.position[0]).normalized();
}

double corner_angle(const Triangle& t, std::size_t corner) {
  const Vec3 a = (t.position[(corner + 1) % 3] - t.position[corner]).normalized();
  const Vec3 b = (t.position[(corner + 2) % 3] - t.position[corner]).normalized();
  return portable_acos(std::clamp(a.dot(b), -1.0, 1.0));
}

}  // namespace

Polyhedron convex_hull(std::span<const Vec3> all_points, std::string name) {
  std::vector<Vec3> points;
  for (const Vec3& p : all_points) {
    const auto same = [&](const Vec3& q) {
      return (p - q).squaredNorm() < kTolerance * kTolerance;
    };
    if (std::none_of(points.begin(), points.end(), same)) points.push_back(p);
  }
  std::vector<Plane> planes;
  const std::size_t n = points.size();
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = i + 1; j < n; ++j) {
      for (std::size_t k = j + 1; k < n; ++k) {
        Plane plane;
        if (!supporting_plane(points, {i, j, k}, plane)) continue;
        const auto same = [&](const Plane& other) {
          return plane.normal.dot(other.normal) > 1 - 1e-8 &&
                 std::abs(plane.offset - other.offset) < 2 * kTolerance;
        };
        if (std::none_of(planes.begin(), planes.end(), same)) planes.push_back(plane);
      }
    }
  }
  Polyhedron hull;
  hull.name = std::move(name);
  std::vector<int> new_index(n, -1);
  for (const Plane& plane : planes) {
    std::vector<int> loop = facet_loop(points, plane);
    for (int& i : loop) {
      int& mapped = new_index[static_cast<std::size_t>(i)];
      if (mapped < 0) {
        mapped = static_cast<int>(hull.vertices.size());
        hull.vertices.push_back(points[static_cast<std::size_t>(i)]);
      }
      i = mapped;
    }
    hull.faces.push_back(std::move(loop));
  }
  PROBE_CHECK(hull.faces.size() >= 4, "the points of a hull lie in one plane");
  return hull;
}

Polyhedron coarse_hull(std::span<const Vec3> points, std::string name) {
  const Box box = bounds(points);
  const Vec3 half = (box.high - box.low) / 2;
  const Vec3 centre = (box.high + box.low) / 2;
  std::vector<Vec3> chosen;
  for (int dx = -1; dx <= 1; ++dx) {
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dz = -1; dz <= 1; ++dz) {
        if (dx == 0 && dy == 0 && dz == 0) continue;
        // Scaled by the box, so that long shapes keep their corners; the first of equals is taken.
        const Vec3 direction(dx / half.x(), dy / half.y(), dz / half.z());
        const Vec3* best = &points[0];
        for (const Vec3& p : points) {
          if (direction.dot(p - centre) > direction.dot(*best - centre) + 1e-9) best = &p;
        }
        chosen.push_back(*best);
      }
    }
  }
  return convex_hull(chosen, std::move(name));
}

void add_faces(Surface& surface, const Polyhedron& polyhedron) {
  for (const std::vector<int>& loop : polyhedron.faces) {
    const auto point = [&](std::size_t i) {
      return polyhedron.vertices[static_cast<std::size_t>(loop[i])];
    };
    for (std::size_t i = 2; i < loop.size(); ++i) {
      Triangle t{.position = {point(0), point(i - 1), point(i)},
                 .normal = {},
                 .uv = {Vec2::Zero(), Vec2::Zero(), Vec2::Zero()}};
      t.normal.fill(face_normal(t));
      surface.push_back(t);
    }
  }
}

void add_grid(Surface& surface, const Grid& grid) {
  const int quads = grid.closed ? grid.columns : grid.columns - 1;
  const int uv_columns = grid.closed ? grid.columns + 1 : grid.columns;
  const auto point = [&](int row, int column) {
    return grid.points[static_cast<std::size_t>(row * grid.columns + column % grid.columns)];
  };
  const auto uv = [&](int row, int column) {
    return grid.uv[static_cast<std::size_t>(row * uv_columns + column)];
  };
  const auto add = [&](std::array<std::array<int, 2>, 3> at) {
    Triangle t;
    for (std::size_t k = 0; k < 3; ++k) {
      t.position[k] = point(at[k][0], at[k][1]);
      t.uv[k] = uv(at[k][0], at[k][1]);
    }
    const Vec3 cross = (t.position[1] - t.position[0]).cross(t.position[2] - t.position[0]);
    if (cross.norm() < 1e-12) return;
    t.normal.fill(cross.normalized());
    surface.push_back(t);
  };
  for (int r = 0; r + 1 < grid.rows; ++r) {
    for (int c = 0; c < quads; ++c) {
      add({{{r, c}, {r + 1, c}, {r + 1, c + 1}}});
      add({{{r, c}, {r + 1, c + 1}, {r, c + 1}}});
    }
  }
}

void smooth_normals(Surface& surface, double max_angle_deg) {
  struct Corner {
    std::size_t triangle;
    double angle;
  };
  const double limit = portable_sincos_deg(max_angle_deg).cos;
  std::map<Key, std::vector<Corner>> corners;
  std::vector<Vec3> flat;
  for (std::size_t i = 0; i < surface.size(); ++i) {
    flat.push_back(face_normal(surface[i]));
    for (std::size_t k = 0; k < 3; ++k) {
      corners[position_key(surface[i].position[k])].push_back({i, corner_angle(surface[i], k)});
    }
  }
  for (std::size_t i = 0; i < surface.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      Vec3 sum = Vec3::Zero();
      for (const Corner& corner : corners[position_key(surface[i].position[k])]) {
        if (flat[i].dot(flat[corner.triangle]) >= limit)
          sum += corner.angle * flat[corner.triangle];
      }
      surface[i].normal[k] = sum.normalized();
    }
  }
}

Box bounds(std::span<const Vec3> points) {
  Box box{points[0], points[0]};
  for (const Vec3& p : points) {
    box.low = box.low.cwiseMin(p);
    box.high = box.high.cwiseMax(p);
  }
  return box;
}

Box bounds(const Surface& surface) {
  Box box = bounds(std::span<const Vec3>(surface[0].position));
  for (const Triangle& t : surface) {
    const Box one = bounds(std::span<const Vec3>(t.position));
    box.low = box.low.cwiseMin(one.low);
    box.high = box.high.cwiseMax(one.high);
  }
  return box;
}

std::vector<Vec3> box_points(const Vec3& low, const Vec3& high, double bevel) {
  std::vector<Vec3> points;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 sign((corner & 1) != 0 ? 1 : -1, (corner & 2) != 0 ? 1 : -1,
                    (corner & 4) != 0 ? 1 : -1);
    const Vec3 at((corner & 1) != 0 ? high.x() : low.x(), (corner & 2) != 0 ? high.y() : low.y(),
                  (corner & 4) != 0 ? high.z() : low.z());
    if (bevel <= 0) {
      points.push_back(at);
      continue;
    }
    for (int axis = 0; axis < 3; ++axis) {
      Vec3 p = at - bevel * sign;
      p[axis] = at[axis];
      points.push_back(p);
    }
  }
  return points;
}

std::vector<Vec3> disc_points(const Disc& disc) {
  std::vector<Vec3> points;
  const int u = (disc.axis + 1) % 3, v = (disc.axis + 2) % 3;
  for (const double along : {disc.low, disc.high}) {
    for (int i = 0; i < disc.corners; ++i) {
      const SinCos turn = portable_sincos(2 * kPi * i / disc.corners);
      Vec3 p = disc.centre;
      p[disc.axis] = along;
      p[u] += disc.radius * turn.cos;
      p[v] += disc.radius * turn.sin;
      points.push_back(p);
    }
  }
  return points;
}

}  // namespace probe::make
