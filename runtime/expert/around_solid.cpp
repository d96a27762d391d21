#include "runtime/expert/around_solid.h"

#include <algorithm>
#include <cmath>

namespace probe::expert {
namespace {

constexpr double kDeepest = 0.020;       // m of a handle that the tool centre point goes down
constexpr double kBesideFinger = 0.006;  // m that a finger needs to its side of what it closes on

double half_along(const Solid& solid, const Pose& pose, const Vec3& direction) {
  const Vec3 own = pose.rotation.conjugate() * direction;
  return own.cwiseAbs().dot(solid.half());
}

}  // namespace

double way_out(const Solid& solid, const Pose& pose, const Vec3& from, const Vec3& direction) {
  const Vec3 own = pose.rotation.conjugate() * direction;
  const Vec3 at = pose.inverse().apply(from) - solid.center();
  double least = 1e9;
  for (int i = 0; i < 3; ++i) {
    if (std::abs(own[i]) < 1e-6) continue;
    const double face = own[i] > 0 ? solid.half()[i] : -solid.half()[i];
    least = std::min(least, (face - at[i]) / own[i]);
  }
  return least;
}

Quat tool_frame(const Vec3& down, const Vec3& closing) {
  Mat3 m;
  m.col(0) = down;
  m.col(1) = closing;
  m.col(2) = down.cross(closing);
  return Quat(m).normalized();
}

std::vector<Vec3> ways_to(const Pose& pose) {
  std::vector<Vec3> ways = {-Vec3::UnitZ()};
  for (int i = 0; i < 3; ++i) {
    const Vec3 axis = pose.rotation * Vec3::Unit(i);
    if (std::abs(axis.z()) > 0.5) continue;
    for (const double sign : {1.0, -1.0}) {
      const Vec3 flat = Vec3(sign * axis.x(), sign * axis.y(), 0).normalized();
      ways.push_back(flat);
      ways.push_back((flat - Vec3::UnitZ()).normalized());
      ways.push_back((flat - 0.5 * Vec3::UnitZ()).normalized());
      ways.push_back((0.5 * flat - Vec3::UnitZ()).normalized());
    }
  }
  return ways;
}

std::vector<FingersAround> fingers_around(const Solid& solid, const Pose& pose,
                                          std::span<const Vec3> ways, const robot::HandShape& hand,
                                          double upright) {
  std::vector<FingersAround> out;
  for (int i = 0; i < 3; ++i) {
    const Vec3 axis = pose.rotation * Vec3::Unit(i);
    for (const Vec3& down : ways) {
      if (std::abs(axis.dot(down)) > upright) continue;
      const Vec3 closing = (axis - axis.dot(down) * down).normalized();
      const double half = half_along(solid, pose, closing);
      if (half > hand.opening_half - kBesideFinger || 2 * half < hand.thinnest) continue;
      const Vec3 along = down.cross(closing);
      const Vec3 middle = pose.apply(solid.center());
      const double slack = std::max(0.0, way_out(solid, pose, middle, along) - hand.finger_half);
      for (const double share : {0.0, 0.6, -0.6}) {
        if (share != 0 && slack < 0.01) continue;
        const Vec3 beside = middle + share * slack * along;
        const double up = way_out(solid, pose, beside, -down);
        const double deep = 0.5 * (up + way_out(solid, pose, beside, down));
        const Vec3 at = beside + (std::min(deep, kDeepest) - up) * down;
        for (const double flip : {1.0, -1.0})
          out.push_back({at, down, flip * closing, half, share});
      }
    }
  }
  return out;
}

}  // namespace probe::expert
