// Starts times directions, scored by room.
#include "runtime/expert/shove.h"

#include <algorithm>
#include <array>
#include <numbers>
#include <vector>

#include "runtime/base/trig.h"
#include "runtime/expert/path_planner.h"

namespace probe::expert {
namespace {

constexpr int kDirections = 16;
constexpr double kFar = 0.065;      // m the source shall move
constexpr double kGap = 0.010;      // m between closed fingers and the source at first
constexpr double kTips = 0.003;     // m above what the source stands on
constexpr double kRoomy = 0.03;     // m; more earns nothing
constexpr double kNearest = 0.002;  // m
constexpr std::size_t kMostWalls = 8, kMostShoves = 20;

struct Candidate {
  Shove shove;
  double cost = 0;
};

// The least gap between the source's way and the others.
double room_on_way(const Scene& scene, const Vec2& way) {
  std::vector<Vec2> swept(scene.source.whole);
  for (const Vec2& p : scene.source.whole) swept.push_back(p + way);
  const Outline outline = convex_outline(std::move(swept));
  double least = kRoomy;
  for (const Footprint* other : others_of(scene, true)) {
    if (other->top < scene.source.bottom + 0.002) continue;
    for (const Outline& part : other->parts) least = std::min(least, separation(outline, part));
  }
  return least;
}

std::vector<Candidate> candidates(const Scene& scene) {
  const robot::HandShape& gripper = scene.hand;
  std::vector<Grasp> walls = grasps_of(scene);
  std::erase_if(walls, [](const Grasp& grasp) { return !grasp.rim; });
  walls.resize(std::min(walls.size(), kMostWalls));
  const std::vector<Ball> balls = gripper_balls(gripper, gripper.opening_half);
  const Obstacles obstacles = obstacles_of(scene, true);
  const double support = std::max(scene.surface, scene.source.bottom);
  std::vector<Candidate> out;
  const auto add = [&](const Grasp& grasp, const Vec2& way, bool closed, double cost) {
    Candidate c;
    c.shove.start = pick_of(scene, grasp);
    c.shove.end = grasp.tcp;
    c.shove.end.position.head<2>() += way;
    c.shove.closed = closed;
    const double room =
        std::min({room_on_way(scene, way), least_clearance(grasp.tcp, balls, obstacles, kRoomy),
                  least_clearance(c.shove.end, balls, obstacles, kRoomy)});
    c.cost = cost + 50 * (kRoomy - std::max(room, kNearest - kRoomy));
    out.push_back(c);
  };
  for (int i = 0; i < kDirections; ++i) {
    const double angle = 2 * std::numbers::pi * i / kDirections;
    const SinCos t = portable_sincos(angle);
    const Vec2 along(t.cos, t.sin);
    for (const Grasp& wall : walls) add(wall, kFar * along, false, 0);
    double behind = 0;
    for (const Vec2& p : scene.source.whole) {
      behind = std::max(behind, -along.dot(p - scene.source.center));
    }
    const Vec2 at = scene.source.center - (behind + gripper.finger_half + kGap) * along;
    for (const double turned : {0.0, std::numbers::pi}) {
      Grasp beside;
      beside.yaw = angle + turned;
      beside.tcp = top_down({at.x(), at.y(), support + gripper.tip_below + kTips}, beside.yaw);
      beside.rim = true;
      add(beside, (kFar + kGap) * along, true, 0.5);
    }
  }
  std::stable_sort(out.begin(), out.end(),
                   [](const Candidate& a, const Candidate& b) { return a.cost < b.cost; });
  return out;
}

}  // namespace

std::optional<Shove> plan_shove(const Scene& scene, const Reach& reach) {
  if (scene.source.whole.size() < 3) return std::nullopt;
  const std::vector<Candidate> all = candidates(scene);
  for (std::size_t i = 0; i < std::min(all.size(), kMostShoves); ++i) {
    const Shove& shove = all[i].shove;
    const std::array way{shove.start.above, shove.start.grasp.tcp, shove.end};
    if (reach.follow(scene.joints, way)) return shove;
  }
  return std::nullopt;
}

}  // namespace probe::expert
