// Sections of both fingers at even heights, at even positions from closed to open.
#include "runtime/stage/turning_hand.h"

#include <algorithm>
#include <cmath>

#include "runtime/robot/grip.h"

namespace probe::stage {
namespace {

constexpr int kGrips = 48;       // steps from closed to open
constexpr double kPad = 0.045;   // m of the fingers from their tips: what holds things
constexpr int kPadLooks = 9;
constexpr double kShorter = 0.012;    // m: tips that are so much higher than at most still reach
constexpr double kThinnest = 0.0005;  // m
constexpr double kNotQuite = 0.02;    // of a finger's length: at the very tip there is no section

double grip_at(const robot::FingerRange& range, int i) {
  return range.closed + (range.open - range.closed) * i / kGrips;
}

// The mean of both fingers' faces at a height.
struct Faces {
  double inner = 0, outer = 0;
  bool found = false;
};
Faces faces_at(const std::vector<Points>& plus, const std::vector<Points>& minus, double x) {
  const Interval a = extent_of(plus, x).inner, b = extent_of(minus, x).inner;
  if (a.empty() || b.empty()) return {};
  return {0.5 * (a.low - b.high), 0.5 * (a.high - b.low), true};
}

double highest(const std::vector<Points>& parts) { return extent_of(parts, 0).x.high; }

robot::FingersAt measured(const std::vector<Points>& plus, const std::vector<Points>& minus,
                          double palm_above) {
  robot::FingersAt out;
  out.tip_below = 0.5 * (highest(plus) + highest(minus));
  out.gap_half = 1e9;
  for (int i = 0; i < kPadLooks; ++i) {
    const double up = kPad * std::max(kNotQuite, i / (kPadLooks - 1.0));
    const Faces faces = faces_at(plus, minus, out.tip_below - up);
    if (faces.found) out.gap_half = std::min(out.gap_half, faces.inner);
  }
  Faces last;
  for (std::size_t i = 0; i < robot::FingersAt::kHeights; ++i) {
    const double share =
        std::max(kNotQuite, static_cast<double>(i) / (robot::FingersAt::kHeights - 1.0));
    const Faces faces = faces_at(plus, minus, out.tip_below - share * (out.tip_below + palm_above));
    if (faces.found) last = faces;
    out.inner[i] = last.inner;
    out.outer[i] = last.outer;
  }
  return out;
}

}  // namespace

bool fingers_turn(const robot::Robot& robot) {
  return std::ranges::all_of(robot.fingers, [&](const robot::Finger& finger) {
    const int joint = robot.model->find_joint(finger.joint);
    return joint >= 0 &&
           robot.model->joints[static_cast<std::size_t>(joint)].kind == robot::JointKind::kRevolute;
  });
}

std::optional<double> facing_grip(const robot::Robot& robot, const UrdfParts& parts,
                                  const robot::Tree& tree) {
  const auto range =
      robot::finger_range(parts.model, robot.control.finger_joints, robot::opens_up(robot.control));
  if (!range.ok()) return std::nullopt;
  double best = 0, least = 1;
  for (int i = 0; i <= kGrips; ++i) {
    const PosedHand hand(robot, parts, tree, grip_at(*range, i));
    const double facing = hand.way_of(robot.fingers[0]).dot(hand.way_of(robot.fingers[1]));
    if (facing < least) least = facing, best = grip_at(*range, i);
  }
  return best;
}

bool measure_turning(const robot::Robot& robot, const UrdfParts& parts, const robot::Tree& tree,
                     const std::array<std::size_t, 2>& links, const Mat3& frame,
                     robot::HandShape* shape) {
  const auto range =
      robot::finger_range(parts.model, robot.control.finger_joints, robot::opens_up(robot.control));
  if (!range.ok()) return false;
  robot::TurningFingers& all = shape->turning;
  for (int i = 0; i <= kGrips; ++i) {
    const PosedHand hand(robot, parts, tree, grip_at(*range, i));
    const std::vector<Points> plus = hand.parts(links[0], frame);
    const std::vector<Points> minus = hand.parts(links[1], frame);
    for (const auto* finger : {&plus, &minus}) {
      const PartsExtent extent = extent_of(*finger, 0);
      shape->finger_half = std::max({shape->finger_half, extent.z.high, -extent.z.low});
    }
    robot::FingersAt at = measured(plus, minus, shape->palm_above);
    at.openness = static_cast<double>(i) / kGrips;
    // Beyond where they meet nothing changes.
    if (at.gap_half <= 0) {
      at.gap_half = 0;
      all.clear();
    }
    if (all.empty() || at.gap_half > all.back().gap_half) all.push_back(at);
  }
  if (all.size() < 2) return false;
  shape->tip_below = -1e9;
  for (const robot::FingersAt& at : all)
    shape->tip_below = std::max(shape->tip_below, at.tip_below);
  for (const robot::FingersAt& at : all) {
    if (at.tip_below < shape->tip_below - kShorter) continue;
    shape->opening_half = at.gap_half;
    shape->outside_half = *std::ranges::max_element(at.outer);
  }
  shape->thinnest = 2 * all.front().gap_half + kThinnest;
  return shape->opening_half > 0;
}

}  // namespace probe::stage
