#include "runtime/expert/free_way.h"

#include <algorithm>
#include <cmath>

#include "runtime/expert/servo.h"
#include "runtime/robot/rotation.h"

namespace probe::expert {
namespace {

constexpr double kGrows = 0.3;  // m of it for a m of way, from what there is at the ends
constexpr double kTurn = 0.1;   // rad between looks
constexpr double kRise = 0.04;  // m from one height that is tried to the next
constexpr int kHeights = 12;

}  // namespace

bool FreeLine::is_free(const Pose& from, const Pose& to) const {
  const double at_start = around->clearance(from, balls, wanted_room);
  const double at_end = around->clearance(to, balls, wanted_room);
  const double whole = (to.position - from.position).norm();
  Pose at = from;
  for (int i = 0; i < 400; ++i) {
    const robot::PoseError left = robot::pose_error(at, to);
    if (left.position < 1e-6 && left.rotation < 1e-6) return true;
    // Turns go along with the way.
    const double share = std::min(1.0, step / std::max(left.position, 1e-9));
    const double turn = left.position > 1e-6 ? std::max(share * left.rotation, 1e-3) : kTurn;
    at = stepped(at, to, step, turn);
    const double gone = (at.position - from.position).norm();
    const double wanted = std::min({wanted_room, at_start - 1e-6 + kGrows * gone,
                                    at_end - 1e-6 + kGrows * (whole - std::min(gone, whole))});
    if (around->clearance(at, balls, wanted_room) < wanted) return false;
  }
  return false;
}

bool is_free_along(const FreeLine& line, const Pose& from, std::span<const Pose> way) {
  const Pose* at = &from;
  for (const Pose& corner : way) {
    if (!line.is_free(*at, corner)) return false;
    at = &corner;
  }
  return true;
}

bool is_set_first(const Surroundings& around, const Pose& from, std::span<const Pose> way,
                  const robot::HandShape& hand, double openness, double open) {
  if (hand.turning.empty()) return false;
  const std::vector<Ball> now = hand_balls(hand, hand.gap_at(openness)).all();
  const std::vector<Ball> then = hand_balls(hand, hand.gap_at(open)).all();
  return !is_free_along({&around, now}, from, way) && is_free_along({&around, then}, from, way);
}

bool are_set(double openness, double open, int decisions) {
  constexpr double kNear = 0.03;  // of openness
  constexpr int kLongest = 10;
  return std::abs(openness - open) < kNear || decisions >= kLongest;
}

std::optional<std::vector<Pose>> free_way(const Surroundings& around, const Pose& from,
                                          const Pose& to, std::span<const Ball> balls) {
  const FreeLine line{&around, balls};
  if (line.is_free(from, to)) return std::vector<Pose>{to};
  const double low = std::max(from.position.z(), to.position.z());
  for (int i = 0; i < kHeights; ++i) {
    Pose up = from, over = to;
    up.position.z() = over.position.z() = low + i * kRise;
    const bool rises = up.position.z() > from.position.z() + 1e-6;
    const bool sinks = over.position.z() > to.position.z() + 1e-6;
    if (rises && !line.is_free(from, up)) continue;
    if (sinks && !line.is_free(over, to)) continue;
    if (!line.is_free(up, over)) continue;
    std::vector<Pose> way;
    if (rises) way.push_back(up);
    way.push_back(over);
    if (sinks) way.push_back(to);
    return way;
  }
  return std::nullopt;
}

}  // namespace probe::expert
