// Turns and heights, scored.
#include "runtime/expert/place_candidates.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "runtime/base/trig.h"
#include "runtime/expert/path_planner.h"
#include "runtime/robot/rotation.h"

namespace probe::expert {
namespace {

constexpr int kTurns = 12;             // over a full turn
constexpr double kTouch = 0.004;       // m, where the smooth path ends and feeling begins
constexpr double kComfortable = 0.01;  // m of clearance; more earns nothing
constexpr double kFeet = 0.004;        // m: how low of the source is its feet
constexpr std::array kLifts{0.0, 0.01, 0.02, 0.03};  // m, let go that much higher
constexpr std::size_t kMostPlaces = 10;              // put to inverse kinematics
constexpr double kWallsNearMark = 0.06;              // m
constexpr double kLeastLift = 0.03;                  // m
// m towards the base while it rises: an arm that is stretched comes no higher where it is.
constexpr std::array kNearer{0.0, 0.08, 0.16, 0.24};
constexpr double kLetsGo = 0.012;                  // m a side that are enough to let go
constexpr double kLittleCost = 0.15;               // of opening no more than that
constexpr double kMarkLevel = 0.006;               // m: what is as high as the mark
constexpr double kRoomyGap = 0.02, kGapCost = 40;  // m between outlines; of a m less

Eigen::Matrix2d turn_by(double angle) {
  const SinCos t = portable_sincos(angle);
  Eigen::Matrix2d m;
  m << t.cos, -t.sin, t.sin, t.cos;
  return m;
}

// What the source stands on: the outline of its lowest few millimetres.
std::vector<Vec2> feet_of(const Scene& scene) {
  std::vector<Vec2> feet;
  for (const std::vector<Vec3>& part : scene.source_parts) {
    for (const Vec3& p : part) {
      if (p.z() < scene.source.bottom + kFeet) feet.emplace_back(p.x(), p.y());
    }
  }
  return convex_outline(std::move(feet));
}

double share_outside(std::span<const Vec2> points, const Scene& scene,
                     const Eigen::Matrix2d& turn) {
  if (points.empty() || scene.target.whole.size() < 3) return 0;
  const Prism target = make_prism(scene.target.whole, -1, 1);
  int outside = 0;
  for (const Vec2& p : points) {
    const Vec2 at = scene.target.center + turn * (p - scene.source.center);
    outside += distance_to(target, {at.x(), at.y(), 0}).value > 0;
  }
  return static_cast<double>(outside) / static_cast<double>(points.size());
}

// Evenly round, and square to the walls that a mark stands between.
std::vector<double> turns_of(const Scene& scene, bool on_mark) {
  std::vector<double> turns;
  for (int i = 0; i < kTurns; ++i)
    turns.push_back(2 * std::numbers::pi / kTurns * (i <= kTurns / 2 ? i : i - kTurns));
  if (!on_mark) return turns;
  const std::vector<double> square = turns_square_to(scene.source.whole, others_of(scene, false),
                                                     scene.target.center, kWallsNearMark);
  turns.insert(turns.end(), square.begin(), square.end());
  return turns;
}

// Wide, and where that may be too much as little as lets go.
std::vector<double> ways_to_open(const Scene& scene, bool on_mark) {
  const double little = scene.hand.opened_by(scene.openness, kLetsGo);
  if (!on_mark || little > 0.9) return {1};
  return {1, little};
}

// The least gap between the source, turned over the target's middle, and what stands higher.
double room_between(const Scene& scene, const Eigen::Matrix2d& turn) {
  Outline moved = scene.source.whole;
  for (Vec2& p : moved) p = scene.target.center + turn * (p - scene.source.center);
  double least = kRoomyGap;
  if (moved.size() < 3) return least;
  for (const Footprint* other : others_of(scene, false)) {
    for (std::size_t i = 0; i < other->parts.size(); ++i) {
      if (other->part_tops[i] < scene.target.top + kMarkLevel || other->parts[i].size() < 3)
        continue;
      least = std::min(least, separation(moved, other->parts[i]));
    }
  }
  return least;
}

}  // namespace

std::vector<Place> place_candidates(const Scene& scene, const Pose& tool, bool on_mark) {
  const robot::HandShape& gripper = scene.hand;
  const std::vector<Ball> held = held_balls(scene, tool);
  const Obstacles obstacles = obstacles_of(scene, false);
  const std::vector<Vec2> feet = feet_of(scene);
  const double rise = scene.target.top + kTouch - scene.source.bottom;
  std::vector<Place> out;
  for (const double openness : ways_to_open(scene, on_mark)) {
    std::vector<Ball> balls = gripper_balls(gripper, gripper.gap_at(openness));
    balls.insert(balls.end(), held.begin(), held.end());
    for (const double turn : turns_of(scene, on_mark)) {
      Place place;
      place.openness = openness;
      place.turn = turn;
      const Eigen::Matrix2d flat = turn_by(place.turn);
      const Vec2 arm = tool.position.head<2>() - scene.source.center;
      const Vec2 at = scene.target.center + flat * arm;
      place.tcp.rotation = robot::from_rotation_vector({0, 0, place.turn}) * tool.rotation;
      double stands = openness < 1 ? kLittleCost : 0;
      if (on_mark) {
        stands += kGapCost * (kRoomyGap - room_between(scene, flat));
      } else {
        place.overhang = share_outside(scene.source.whole, scene, flat);
        stands += 0.4 * place.overhang + share_outside(feet, scene, flat);
      }
      for (const double lift : kLifts) {
        place.lift = lift;
        place.tcp.position = {at.x(), at.y(), tool.position.z() + rise + lift};
        place.clearance = least_clearance(place.tcp, balls, obstacles, kComfortable);
        place.cost = 0.3 * std::abs(place.turn) + stands + 20 * lift +
                     100 * (kComfortable - place.clearance);
        out.push_back(place);
        if (place.clearance >= kComfortable) break;
      }
    }
  }
  std::stable_sort(out.begin(), out.end(),
                   [](const Place& a, const Place& b) { return a.cost < b.cost; });
  return out;
}

std::optional<Place> plan_place(const Scene& scene, const Reach& reach,
                                std::span<const double> joints, bool on_mark) {
  const Pose tool = reach.chain().pose(joints.first(reach.chain().joint_count()));
  const std::vector<Place> places = place_candidates(scene, tool, on_mark);
  const double hang = std::max(scene.hand.tip_below, tool.position.z() - scene.source.bottom);
  for (std::size_t i = 0; i < std::min(places.size(), kMostPlaces); ++i) {
    if (way_to_place(scene, reach, joints, hang, places[i].tcp)) return places[i];
  }
  return std::nullopt;
}

std::optional<std::vector<JointVector>> way_to_place(const Scene& scene, const Reach& reach,
                                                     std::span<const double> joints, double hang,
                                                     const Pose& place) {
  const Pose tool = reach.chain().pose(joints.first(reach.chain().joint_count()));
  Pose lifted = tool, over = place;
  lifted.position.z() = std::max(tool.position.z() + kLeastLift,
                                 travel_height(scene, hang, tool.position, place.position));
  over.position.z() = std::max(place.position.z(), lifted.position.z());
  const Vec2 from = tool.position.head<2>();
  for (const double nearer : kNearer) {
    lifted.position.head<2>() = from * std::max(0.0, 1 - nearer / std::max(from.norm(), 1e-9));
    if (auto way = reach.follow(joints, std::array{lifted, over, place})) return way;
    if (!scene.low_ways) break;
  }
  return std::nullopt;
}

}  // namespace probe::expert
