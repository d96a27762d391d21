// A robot as data: what its description, the plan and its own shape say of it. Any number of
// fingers, or none. Read by whoever acts for it: the controller, the expert, what is measured.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "runtime/base/geometry.h"
#include "runtime/robot/control.h"
#include "runtime/robot/laws.h"
#include "runtime/robot/turning_fingers.h"
#include "runtime/robot/urdf.h"

namespace probe::robot {

struct Finger {
  std::string link;
  std::string joint;           // the one above the link
  Vec3 opens = Vec3::UnitY();  // unit, link frame: where it moves when the hand opens
};

// The room that a hand of two fingers takes, m, in the grasp frame: its origin is the tool centre
// point, x is where the hand points (down in a grasp from above), the fingers close along y, z is
// along their width.
struct HandShape {
  double tip_below = 0;                  // fingertips past the tool centre point, at most
  double palm_above = 0;                 // underside of what holds the fingers
  double finger_half = 0;                // half the width of a finger, along z
  double opening_half = 0;               // inner faces from the middle, fingers open, mid-height
  double outside_half = 0;               // outer faces
  double palm_half = 0;                  // along y
  double palm_back = 0, palm_front = 0;  // along -z and +z
  double thinnest = 0;                   // the least width that the closed fingers hold
  // Outer faces again, from the fingertips up to the palm at even heights; all 0: as outside_half.
  std::array<double, 6> tapered{};

  // Of fingers that turn, where they are; `opening_half` and `outside_half` are then those of the
  // widest opening at which their tips still reach far enough. Empty: they slide.
  TurningFingers turning{};

  // How far the inner faces are from the middle at an openness of the gripper, and back.
  double gap_at(double openness) const {
    return turning.empty() ? openness * opening_half : fingers_at(turning, openness).gap_half;
  }
  double openness_for(double gap_half) const {
    return turning.empty() ? gap_half / opening_half : openness_of_gap(turning, gap_half);
  }
  // The openness at which they stand at `opening_half`: as wide as the hand is taken for. Fingers
  // that turn can stand out farther.
  double widest() const { return turning.empty() ? 1 : openness_of_gap(turning, opening_half); }
  // Inner faces on a way that begins at one openness and ends at another. Fingers that turn are
  // brought to the latter first where the way is not free with both: wide open they stand out far
  // to both sides.
  double widest_on_way(double from, double to) const {
    return gap_at(turning.empty() ? std::max(from, to) : to);
  }
  // The openness at which the inner faces are `more` farther from the middle.
  double opened_by(double openness, double more) const {
    return turning.empty() ? openness + more / opening_half
                           : openness_of_gap(turning, gap_at(openness) + more);
  }

  // Outer faces from the middle at a height, x from the tool centre point towards the tips.
  double outside_at(double x) const {
    if (tapered.back() <= 0) return outside_half;
    constexpr std::size_t kLast = 5;
    const double up = (tip_below - x) / (tip_below + palm_above) * static_cast<double>(kLast);
    const auto below = static_cast<std::size_t>(std::clamp(up, 0.0, static_cast<double>(kLast)));
    return std::max(tapered[below], tapered[std::min(below + 1, kLast)]);
  }
};

struct Hand {
  HandShape shape;
  Quat approach = Quat::Identity();  // the grasp frame in the frame of the tool centre point's link
};

struct Robot {
  std::string name;                   // as the text declares it, not as its description calls it
  const RobotModel* model = nullptr;  // outlives the robot
  std::string tcp_link;
  std::vector<std::string> joints;  // those that have drives, in the order of q
  std::vector<Finger> fingers;
  EeControlSpec control;
  Law law;                   // what its controller does
  std::optional<Hand> hand;  // where there are two fingers that close on each other
};

}  // namespace probe::robot
