#include "runtime/expert/away.h"

#include <algorithm>
#include <array>
#include <numbers>
#include <vector>

#include "runtime/base/trig.h"

namespace probe::expert {
namespace {

constexpr int kDirections = 16;                     // around the source
constexpr std::array kDistances{0.10, 0.13, 0.16};  // m from where the source is
constexpr double kRoomy = 0.04;                     // m between outlines; more earns nothing
constexpr double kNarrow = 0.015;                   // m between outlines; no spot has less
constexpr double kOffTarget = 0.03;  // m beyond the target's half diagonal, from centre to centre
constexpr double kAbove = 0.08;      // m over the surface

struct Spot {
  Vec2 at = Vec2::Zero();
  double cost = 0;
};

// The least gap between the source's outline and the others', moved by `way`.
double room_at(const Scene& scene, const Vec2& way) {
  Outline moved = scene.source.whole;
  for (Vec2& p : moved) p += way;
  double least = kRoomy;
  for (const Footprint* other : others_of(scene, true)) {
    for (const Outline& part : other->parts) least = std::min(least, separation(moved, part));
  }
  return least;
}

}  // namespace

std::optional<Vec2> find_spot(const Scene& scene, const Reach& reach) {
  const double apart = half_diagonal(scene.target) + kOffTarget;
  std::vector<Spot> spots;
  for (const double distance : kDistances) {
    for (int i = 0; i < kDirections; ++i) {
      const SinCos t = portable_sincos(2 * std::numbers::pi * i / kDirections);
      const Vec2 way = distance * Vec2(t.cos, t.sin);
      const Vec2 at = scene.source.center + way;
      const double room = room_at(scene, way);
      const bool is_on_target =
          !scene.target.whole.empty() && (at - scene.target.center).norm() < apart;
      if (room < kNarrow || is_on_target) continue;
      spots.push_back({at, 50 * (kRoomy - room) + 10 * distance});
    }
  }
  std::stable_sort(spots.begin(), spots.end(),
                   [](const Spot& a, const Spot& b) { return a.cost < b.cost; });
  const double yaw = yaw_of(scene.tcp.rotation);
  const double low = scene.surface + scene.hand.tip_below;
  for (const Spot& spot : spots) {
    const Pose above = top_down({spot.at.x(), spot.at.y(), low + kAbove}, yaw);
    const Pose there = top_down({spot.at.x(), spot.at.y(), low}, yaw);
    if (reach.follow(scene.joints, std::array{above, there})) return spot.at;
  }
  return std::nullopt;
}

}  // namespace probe::expert
