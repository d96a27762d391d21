// Surface nets and the distances that feed them. Knows nothing of textures.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "assets/make/shapes.h"

namespace probe::make {
namespace {

Vec3 gradient(const Field& field, const Vec3& p) {
  constexpr double kStep = 0.02;
  Vec3 g;
  for (int axis = 0; axis < 3; ++axis) {
    Vec3 d = Vec3::Zero();
    d[axis] = kStep;
    g[axis] = (field(p + d) - field(p - d)) / (2 * kStep);
  }
  return g;
}

// The samples of a field on a lattice and the point of each cube that its surface crosses.
class Net {
 public:
  Net(const Field& field, const Box& box, double cell) : field_(field), low_(box.low), cell_(cell) {
    for (int axis = 0; axis < 3; ++axis) {
      size_[static_cast<std::size_t>(axis)] =
          static_cast<int>(std::ceil((box.high[axis] - box.low[axis]) / cell)) + 1;
    }
    for (int z = 0; z < size_[2]; ++z) {
      for (int y = 0; y < size_[1]; ++y) {
        for (int x = 0; x < size_[0]; ++x) samples_.push_back(field(corner({x, y, z})));
      }
    }
  }

  Surface surface() {
    Surface out;
    // Each lattice edge whose ends differ in sign is crossed by the quad of its four cubes.
    for (int z = 1; z + 1 < size_[2]; ++z) {
      for (int y = 1; y + 1 < size_[1]; ++y) {
        for (int x = 1; x + 1 < size_[0]; ++x) {
          for (std::size_t axis = 0; axis < 3; ++axis) add_quad(out, {x, y, z}, axis);
        }
      }
    }
    return out;
  }

 private:
  using Place = std::array<int, 3>;

  Vec3 corner(const Place& at) const { return low_ + cell_ * Vec3(at[0], at[1], at[2]); }
  double sample(const Place& at) const {
    return samples_[static_cast<std::size_t>((at[2] * size_[1] + at[1]) * size_[0] + at[0])];
  }

  // The mean of the crossings on the cube's edges, drawn onto the level.
  const Vec3& cube_point(const Place& at) {
    const auto found = points_.find(at);
    if (found != points_.end()) return found->second;
    Vec3 sum = Vec3::Zero();
    int count = 0;
    for (int a = 0; a < 8; ++a) {
      for (int bit = 1; bit < 8; bit *= 2) {
        if ((a & bit) != 0) continue;
        const auto place = [&](int c) {
          return Place{at[0] + (c & 1), at[1] + ((c >> 1) & 1), at[2] + ((c >> 2) & 1)};
        };
        const double da = sample(place(a)), db = sample(place(a | bit));
        if ((da < 0) == (db < 0)) continue;
        const Vec3 pa = corner(place(a)), pb = corner(place(a | bit));
        sum += pa + (pb - pa) * (da / (da - db));
        ++count;
      }
    }
    Vec3 p = sum / count;
    for (int step = 0; step < 4; ++step) {
      const Vec3 g = gradient(field_, p);
      const double square = g.squaredNorm();
      if (square < 1e-6) break;
      const Vec3 move = -field_(p) / square * g;
      p += move * std::min(1.0, 0.5 * cell_ / std::max(move.norm(), 1e-9));
    }
    return points_.emplace(at, p).first->second;
  }

  void add_quad(Surface& out, const Place& at, std::size_t axis) {
    Place next = at;
    ++next[axis];
    const bool inside = sample(at) < 0;
    if (inside == (sample(next) < 0)) return;
    const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
    std::array<Vec3, 4> quad;
    constexpr std::array<std::array<int, 2>, 4> kAround{{{-1, -1}, {0, -1}, {0, 0}, {-1, 0}}};
    for (std::size_t k = 0; k < 4; ++k) {
      Place cube = at;
      cube[u] += kAround[k][0];
      cube[v] += kAround[k][1];
      quad[k] = cube_point(cube);
    }
    if (!inside) std::swap(quad[1], quad[3]);
    // Along the shorter diagonal.
    const std::size_t s =
        (quad[0] - quad[2]).squaredNorm() <= (quad[1] - quad[3]).squaredNorm() ? 0 : 1;
    add_triangle(out, {quad[s], quad[s + 1], quad[s + 2]});
    add_triangle(out, {quad[s], quad[s + 2], quad[(s + 3) % 4]});
  }

  void add_triangle(Surface& out, const std::array<Vec3, 3>& at) {
    const Vec3 cross = (at[1] - at[0]).cross(at[2] - at[0]);
    if (cross.norm() < 1e-6) return;
    Triangle t{.position = at, .normal = {}, .uv = {Vec2::Zero(), Vec2::Zero(), Vec2::Zero()}};
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 g = gradient(field_, at[k]);
      t.normal[k] = g.squaredNorm() > 1e-6 ? g.normalized() : cross.normalized();
    }
    out.push_back(t);
  }

  const Field& field_;
  Vec3 low_;
  double cell_;
  std::array<int, 3> size_{};
  std::vector<double> samples_;
  std::map<Place, Vec3> points_;
};

}  // namespace

Surface blob(const Field& field, const Box& box, double cell) {
  return Net(field, box, cell).surface();
}

double smooth_union(double a, double b, double radius) {
  const double h = clamp01(0.5 + 0.5 * (b - a) / radius);
  return b + (a - b) * h - radius * h * (1 - h);
}

double ellipsoid_distance(const Vec3& p, const Vec3& centre, const Vec3& radii) {
  const Vec3 q = (p - centre).cwiseQuotient(radii);
  const double k = q.norm();
  const double slope = q.cwiseQuotient(radii).norm();
  return slope < 1e-9 ? -radii.minCoeff() : k * (k - 1) / slope;
}

double capsule_distance(const Vec3& p, const Vec3& a, const Vec3& b, double radius) {
  const Vec3 along = b - a, to = p - a;
  const double t = clamp01(to.dot(along) / along.squaredNorm());
  return (to - t * along).norm() - radius;
}

}  // namespace probe::make
