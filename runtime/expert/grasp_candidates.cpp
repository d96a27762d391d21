// Enumerates yaws (a grid, and those square to the outline's edges) and positions along the object,
// and scores each.
#include "runtime/expert/grasp_candidates.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "runtime/base/trig.h"
#include "runtime/expert/depths.h"
#include "runtime/robot/rotation.h"

namespace probe::expert {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr int kYaws = 36;  // over half a turn; the other half is the same grasp turned round
constexpr double kAlongStep = 0.005;    // m, positions along the object
constexpr double kAlongMost = 0.030;    // m to either side of its centre
constexpr double kSideMargin = 0.0008;  // m, between each open finger and the object
constexpr double kEasySide = 0.006;     // m, wider earns nothing more
constexpr double kMiddle = 0.001;       // m to either side of the line in which fingers close
constexpr double kNearest = 0.002;      // m, to another object
constexpr double kComfortable = 0.02;   // m, farther away earns nothing more
constexpr std::array kRimHeights{0.0030, 0.0036, 0.006, 0.010, 0.020, 0.030};  // m, of fingertips
constexpr double kBesideSource = 0.012;  // m, of fingers that are set before they come
constexpr std::array kRimOffs{0.0, 0.02, -0.02, 0.035, -0.035};  // m from the middle
constexpr double kRimOffCost = 10;                               // of a m
constexpr double kNearBase = 0.6, kStretchCost = 10;  // m from the base; what a m more costs
constexpr double kRimDepth = 0.002;                   // m, of a wall between the fingers at least

double wrapped(double angle) {
  while (angle > kPi) angle -= 2 * kPi;
  while (angle <= -kPi) angle += 2 * kPi;
  return angle;
}

struct Directions {
  Vec2 close;   // tool y: the fingers close along it
  Vec2 across;  // tool z: along the width of a finger
};

Directions directions_of(double yaw) {
  const SinCos t = portable_sincos(yaw);
  return {{-t.sin, t.cos}, {t.cos, t.sin}};
}

Outline box(const Vec2& center, const Directions& d, double close_a, double close_b,
            double across_a, double across_b) {
  return convex_outline({center + close_a * d.close + across_a * d.across,
                         center + close_b * d.close + across_a * d.across,
                         center + close_b * d.close + across_b * d.across,
                         center + close_a * d.close + across_b * d.across});
}

std::vector<double> yaws_for(const Footprint& source) {
  std::vector<double> yaws;
  for (int i = 0; i < kYaws; ++i) yaws.push_back(kPi * i / kYaws);
  for (std::size_t i = 0; i < source.whole.size(); ++i) {
    const Vec2 edge = source.whole[(i + 1) % source.whole.size()] - source.whole[i];
    // Fingers along the edge: tool z along it.
    if (edge.norm() > 0.01) yaws.push_back(portable_atan2(edge.y(), edge.x()));
  }
  return yaws;
}

// How far the open gripper, lowered to `z`, stays from everything else. Low things meet only the
// fingers, those higher than the palm's underside also the palm.
double clearance_of(const GraspProblem& problem, const robot::HandShape& g, const Directions& d,
                    const Vec3& at) {
  const Vec2 center = at.head<2>();
  const Outline left =
      box(center, d, g.opening_half, g.outside_half, -g.finger_half, g.finger_half);
  const Outline right =
      box(center, d, -g.outside_half, -g.opening_half, -g.finger_half, g.finger_half);
  const Outline palm = box(center, d, -g.palm_half, g.palm_half, -g.palm_back, g.palm_front);
  double least = std::numeric_limits<double>::infinity();
  const double reach =
      std::sqrt(g.palm_half * g.palm_half + g.palm_front * g.palm_front) + kComfortable;
  for (const Footprint* other : problem.others) {
    if ((other->center - center).norm() > other->radius + reach) continue;
    for (const Outline& part : other->parts) {
      if (other->top > at.z() - g.tip_below) {
        least = std::min({least, separation(left, part), separation(right, part)});
      }
      if (other->top > at.z() + g.palm_above) least = std::min(least, separation(palm, part));
    }
  }
  return least;
}

// Stretches of the slab that outlines cover, merged.
std::vector<Extent> covered(std::span<const Outline> outlines, const Slab& slab,
                            const Vec2& along) {
  std::vector<Extent> all;
  for (std::size_t i = 0; i < outlines.size(); ++i) {
    const Extent e = extent_in_slab(outlines.subspan(i, 1), slab, along);
    if (!e.empty()) all.push_back(e);
  }
  std::sort(all.begin(), all.end(),
            [](const Extent& a, const Extent& b) { return a.lower < b.lower; });
  std::vector<Extent> out;
  for (const Extent& e : all) {
    if (!out.empty() && e.lower <= out.back().upper) {
      out.back().upper = std::max(out.back().upper, e.upper);
    } else {
      out.push_back(e);
    }
  }
  return out;
}

double stretch_cost(const GraspProblem& problem, const Vec2& at) {
  return problem.minds_stretch ? kStretchCost * std::max(0.0, at.norm() - kNearBase) : 0;
}

// As wide as it needs to be: the fingers set `kBesideSource` from each side of what they take.
robot::HandShape set_to(const GraspProblem& problem, double width) {
  robot::HandShape hand = problem.gripper;
  const double opening = std::min(0.5 * width + kBesideSource, hand.opening_half);
  hand.outside_half -= hand.opening_half - opening;
  hand.opening_half = opening;
  if (!hand.turning.empty()) {
    const auto outer = robot::fingers_at(hand.turning, hand.openness_for(opening)).outer;
    hand.outside_half = *std::ranges::max_element(outer);
  }
  return hand;
}

// Between a wall of the object, such as the rim of a plate: one finger stands inside the outline,
// as low as what is below it allows.
void add_rim_grasps(const GraspProblem& problem, std::vector<Grasp>& out) {
  const Footprint& source = *problem.source;
  const robot::HandShape& g = problem.gripper;
  for (const double height : kRimHeights) {
    const double tips = problem.surface + height;
    if (tips > source.top - kRimDepth) return;
    const std::vector<Outline> walls = section_above(problem.parts, tips);
    const double z = std::max(tips + g.tip_below, source.top - g.palm_above + 0.004);
    for (int i = 0; i < kYaws; ++i) {
      const double half_turn = kPi * i / kYaws;
      const Directions d = directions_of(half_turn);
      // Beside the middle, too, where there is little room.
      const std::span<const double> offs =
          problem.narrow ? std::span<const double>(kRimOffs) : std::span(kRimOffs).first(1);
      for (const double off : offs) {
        const Slab slab{d.across, d.across.dot(source.center) + off, g.finger_half};
        for (const Extent& wall : covered(walls, slab, d.close)) {
          if (wall.width() < g.thinnest || wall.width() > 2 * (g.opening_half - kSideMargin))
            continue;
          const Vec2 xy = 0.5 * (wall.lower + wall.upper) * d.close + slab.at * d.across;
          const robot::HandShape set = problem.narrow ? set_to(problem, wall.width()) : g;
          const Outline left =
              box(xy, d, set.opening_half, set.outside_half, -g.finger_half, g.finger_half);
          const Outline right =
              box(xy, d, -set.outside_half, -set.opening_half, -g.finger_half, g.finger_half);
          const bool free = std::all_of(walls.begin(), walls.end(), [&](const Outline& o) {
            return separation(left, o) > 0.001 && separation(right, o) > 0.001;
          });
          if (!free) continue;
          for (const double turn : {0.0, kPi}) {
            Grasp grasp;
            grasp.rim = true;
            grasp.yaw = wrapped(half_turn + turn);
            grasp.tcp = top_down({xy.x(), xy.y(), z}, grasp.yaw);
            grasp.width = wall.width();
            grasp.off_center = (xy - source.center).norm();
            grasp.open = g.openness_for(set.opening_half);
            grasp.clearance =
                clearance_of(problem, set, directions_of(grasp.yaw), grasp.tcp.position);
            if (grasp.clearance < kNearest) continue;
            grasp.cost = 100 * height - 40 * std::min(grasp.width, 0.02) +
                         0.5 * std::max(0.0, 1 - grasp.clearance / kComfortable) +
                         0.15 * std::abs(wrapped(grasp.yaw - problem.yaw_now)) +
                         kRimOffCost * std::abs(off) + stretch_cost(problem, xy);
            out.push_back(grasp);
          }
        }
      }
    }
  }
}

}  // namespace

Pose top_down(const Vec3& position, double yaw) {
  Mat3 down;
  down << 0, 0, 1, 0, 1, 0, -1, 0, 0;
  return {position, (robot::from_rotation_vector({0, 0, yaw}) * Quat(down)).normalized()};
}

double yaw_of(const Quat& rotation) {
  // Tool z lies along base x at yaw 0; tool y along base y. Their mean survives a small tilt.
  const Vec3 z = rotation * Vec3::UnitZ(), y = rotation * Vec3::UnitY();
  return portable_atan2(z.y() - y.x(), z.x() + y.y());
}

double side_room(const robot::HandShape& gripper, double width) {
  return gripper.opening_half - 0.5 * width;
}

std::vector<Grasp> grasp_candidates(const GraspProblem& problem) {
  const Footprint& source = *problem.source;
  const robot::HandShape& g = problem.gripper;
  // As low as the surface allows, unless the palm would meet the top of the object. Flat objects
  // need the tips lower.
  const double margin =
      std::clamp(0.25 * (source.top - problem.surface), 0.0015, problem.tip_margin);
  const double lowest = problem.surface + g.tip_below + margin;
  const double z = std::max(lowest, source.top - g.palm_above + 0.004);
  const Depths depths(problem, lowest);
  std::vector<Grasp> out;
  const bool too_high = z - g.tip_below > source.top - 0.003;  // the fingers would close above it
  for (const double half_turn : too_high ? std::vector<double>{} : yaws_for(source)) {
    const Directions d = directions_of(half_turn);
    const double middle = d.across.dot(source.center);
    for (double along = -kAlongMost; along <= kAlongMost + 1e-9; along += kAlongStep) {
      const Slab slab{d.across, middle + along, g.finger_half};
      const Extent extent = extent_in_slab(source.parts, slab, d.close);
      if (extent.empty() || extent.width() > 2 * (g.opening_half - kSideMargin)) continue;
      // What only a side of the fingers meets turns out of them when they close.
      if (extent_in_slab(source.parts, {d.across, slab.at, kMiddle}, d.close).empty()) continue;
      const auto deep = g.turning.empty() ? std::optional(z) : depths.around(slab, d.close, extent);
      if (!deep) continue;
      const Vec2 xy = 0.5 * (extent.lower + extent.upper) * d.close + slab.at * d.across;
      const robot::HandShape set = problem.narrow ? set_to(problem, extent.width()) : g;
      for (const double turn : {0.0, kPi}) {
        Grasp grasp;
        grasp.yaw = wrapped(half_turn + turn);
        grasp.tcp = top_down({xy.x(), xy.y(), *deep}, grasp.yaw);
        grasp.width = extent.width();
        grasp.off_center = along;
        grasp.open = g.openness_for(set.opening_half);
        grasp.clearance = clearance_of(problem, set, directions_of(grasp.yaw), grasp.tcp.position);
        if (grasp.clearance < kNearest) continue;
        grasp.cost = 20 * grasp.width + 50 * std::abs(along) +
                     0.5 * std::max(0.0, 1 - grasp.clearance / kComfortable) +
                     0.5 * std::max(0.0, 1 - side_room(g, grasp.width) / kEasySide) +
                     0.15 * std::abs(wrapped(grasp.yaw - problem.yaw_now)) +
                     stretch_cost(problem, xy);
        out.push_back(grasp);
      }
    }
  }
  if (out.empty()) add_rim_grasps(problem, out);
  std::stable_sort(out.begin(), out.end(),
                   [](const Grasp& a, const Grasp& b) { return a.cost < b.cost; });
  return out;
}

}  // namespace probe::expert
