#include "runtime/stage/backdrop.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "runtime/scene/covered_mesh.h"

namespace probe::stage {
namespace {

constexpr int kPlaces = 13;  // a side
constexpr double kNothing = -std::numeric_limits<double>::infinity();

// Where a plumb line first meets something, at places in the middle of equal parts of the area.
class Heights {
 public:
  explicit Heights(const std::array<double, 4>& area) : area_(area) {
    const double width = area[2] - area[0], depth = area[3] - area[1];
    for (int k = 0; k < kPlaces; ++k) {
      x_.push_back(area[0] + width * (k + 0.5) / kPlaces);
      y_.push_back(area[1] + depth * (k + 0.5) / kPlaces);
    }
    z_.assign(static_cast<std::size_t>(kPlaces) * kPlaces, kNothing);
  }

  void add(const SeenMesh& seen) {
    if (seen.mesh == nullptr) return;
    for (const scene::MeshPart& part : seen.mesh->parts) {
      const auto corner = [&](std::size_t i) -> Vec3 {
        const std::size_t at = 3 * std::size_t{part.indices[i]};
        return Vec3(part.positions[at], part.positions[at + 1], part.positions[at + 2]) +
               seen.position;
      };
      for (std::size_t i = 0; i + 2 < part.indices.size(); i += 3) {
        add_triangle(corner(i), corner(i + 1), corner(i + 2));
      }
    }
  }

  const std::vector<double>& z() const { return z_; }

 private:
  void add_triangle(const Vec3& a, const Vec3& b, const Vec3& c) {
    const auto [left, right] = std::minmax({a.x(), b.x(), c.x()});
    const auto [front, back] = std::minmax({a.y(), b.y(), c.y()});
    if (right < area_[0] || left > area_[2] || back < area_[1] || front > area_[3]) return;
    const auto cross = [](const Vec3& u, const Vec3& v, double x, double y) {
      return (v.x() - u.x()) * (y - u.y()) - (v.y() - u.y()) * (x - u.x());
    };
    const double whole = cross(a, b, c.x(), c.y());
    if (whole == 0) return;  // upright
    for (std::size_t i = 0; i < x_.size(); ++i) {
      if (x_[i] < left || x_[i] > right) continue;
      for (std::size_t j = 0; j < y_.size(); ++j) {
        const double u = cross(b, c, x_[i], y_[j]) / whole;
        const double v = cross(c, a, x_[i], y_[j]) / whole;
        const double w = 1 - u - v;
        if (u < 0 || v < 0 || w < 0) continue;
        double& z = z_[i * y_.size() + j];
        z = std::max(z, u * a.z() + v * b.z() + w * c.z());
      }
    }
  }

  std::array<double, 4> area_;
  std::vector<double> x_, y_, z_;
};

}  // namespace

namespace {

constexpr double kOtherThing = 0.5;  // m from the surface: the floor of a room

// The longest run of ascending heights that agree: first and count.
std::pair<std::size_t, std::size_t> longest_run(const std::vector<double>& heights) {
  constexpr double kAgree = 0.005;  // m
  std::size_t first = 0, most = 0;
  for (std::size_t low = 0, high = 0; high < heights.size(); ++high) {
    while (heights[high] - heights[low] > kAgree) ++low;
    if (high - low + 1 <= most) continue;
    most = high - low + 1;
    first = low;
  }
  return {first, most};
}

}  // namespace

std::optional<double> table_height(const SeenMesh& backdrop, const SeenMesh& fixture,
                                   const std::array<double, 4>& area,
                                   std::optional<double> surface_z) {
  Heights below(area), above(area);
  below.add(backdrop);
  above.add(fixture);
  std::vector<double> counted;
  for (std::size_t k = 0; k < below.z().size(); ++k) {
    if (below.z()[k] > above.z()[k]) counted.push_back(below.z()[k]);
  }
  std::sort(counted.begin(), counted.end());
  const std::size_t places = below.z().size(), all = counted.size();
  std::optional<double> nearest;
  for (;;) {
    const auto [first, most] = longest_run(counted);
    if (10 * most < places || most == 0) return nearest;
    const double height = counted[first + most / 2];
    if (!surface_z) return 2 * most < all ? std::nullopt : std::optional(height);
    const double away = std::abs(height - *surface_z);
    if (away <= kOtherThing && (!nearest || away < std::abs(*nearest - *surface_z)))
      nearest = height;
    const auto run = counted.begin() + static_cast<std::ptrdiff_t>(first);
    counted.erase(run, run + static_cast<std::ptrdiff_t>(most));
  }
}

double backdrop_lift(std::optional<double> table_height, double surface_z) {
  constexpr double kMeant = 0.002;  // m
  if (!table_height) return 0;
  const double lift = surface_z - *table_height;
  return std::abs(lift) <= kMeant || std::abs(lift) > kOtherThing ? 0 : lift;
}

double backdrop_lift(const plan::SceneRecord& scene, std::optional<double> table_height) {
  return scene.backdrop_stands != 0 ? scene.surface_z - scene.backdrop_z
                                    : backdrop_lift(table_height, scene.surface_z);
}

Result<scene::Mesh> covered_backdrop(const scene::Mesh& backdrop, const SeenMesh& fixture,
                                     const std::array<double, 4>& area, double surface_z,
                                     std::span<const Cover> covers) {
  constexpr double kLevel = 0.9, kUpright = 0.3;         // of the normal's z
  constexpr double kAtTable = 0.015, kBelowTable = 0.2;  // m
  constexpr double kAtFloor = 0.05;                      // m
  const double table = table_height({&backdrop}, fixture, area, surface_z).value_or(surface_z);
  double lowest = std::numeric_limits<double>::infinity();
  for (const scene::MeshPart& part : backdrop.parts) {
    for (std::size_t i = 2; i < part.positions.size(); i += 3)
      lowest = std::min(lowest, static_cast<double>(part.positions[i]));
  }
  scene::Mesh made = backdrop;
  for (const Cover& cover : covers) {
    const auto is_covered = [&](const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& normal) {
      const double low = std::min({a.z(), b.z(), c.z()}), high = std::max({a.z(), b.z(), c.z()});
      const bool is_level = std::abs(normal.z()) > kLevel;
      switch (cover.of) {
        case plan::CoverOf::kSurface:
          return is_level && std::abs(low - table) < kAtTable && std::abs(high - table) < kAtTable;
        case plan::CoverOf::kWalls:
          return std::abs(normal.z()) < kUpright && high > table + kAtTable;
        case plan::CoverOf::kFloor:
          // Of a room without a table things stand on the floor itself.
          return is_level && high < lowest + kAtFloor &&
                 (high < table - kBelowTable || table < lowest + kAtTable);
        case plan::CoverOf::kObject:
          break;
      }
      return false;
    };
    std::size_t count = 0;
    made = scene::covered_mesh(made, *cover.picture, cover.side, is_covered, &count);
    if (count > 0) continue;
    const char* const what = cover.of == plan::CoverOf::kSurface ? "a surface"
                             : cover.of == plan::CoverOf::kWalls ? "walls"
                                                                 : "a floor";
    return Failure{Fault::kRender,
                   std::string("the backdrop has nothing that looks like ") + what +
                       ": its texture would cover nothing",
                   backdrop.name};
  }
  return made;
}

}  // namespace probe::stage
