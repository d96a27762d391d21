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
  double tip_below = 0;                  // fingertips past the tool centre point
  double palm_above = 0;                 // underside of what holds the fingers
  double finger_half = 0;                // half the width of a finger, along z
  double opening_half = 0;               // inner faces from the middle, fingers open, mid-height
  double outside_half = 0;               // outer faces
  double palm_half = 0;                  // along y
  double palm_back = 0, palm_front = 0;  // along -z and +z
  double thinnest = 0;                   // the least width that the closed fingers hold
  // Outer faces again, from the fingertips up to the palm at even heights; all 0: as outside_half.
  std::array<double, 6> tapered{};

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
  std::string name;                   // the description's
  const RobotModel* model = nullptr;  // outlives the robot
  std::string tcp_link;
  std::vector<std::string> joints;  // those that have drives, in the order of q
  std::vector<Finger> fingers;
  EeControlSpec control;
  Law law;                   // what its controller does
  std::optional<Hand> hand;  // where there are two fingers that close on each other
};

}  // namespace probe::robot
