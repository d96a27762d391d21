// The convex parts of a hand's links with its fingers at one position, seen from the link of the
// tool centre point: what hands are measured from.
#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "runtime/base/geometry.h"
#include "runtime/robot/kinematics.h"
#include "runtime/robot/robot.h"
#include "runtime/stage/assets.h"

namespace probe::stage {

using Points = std::vector<Vec3>;

struct Interval {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  void add(double value);
  bool empty() const { return low > high; }
};

class PosedHand {
 public:
  // The finger joints at `grip`, within their limits; all others at 0. The parts and the tree
  // outlive it.
  PosedHand(const robot::Robot& robot, const UrdfParts& parts, const robot::Tree& tree,
            double grip);

  Pose in_tcp(std::size_t link) const { return to_tcp_ * poses_[link]; }
  // Which way a finger goes when the hand opens; the tool's frame.
  Vec3 way_of(const robot::Finger& finger) const;
  // Vertices of each convex part of a link, turned into `frame` (of the tool's link).
  std::vector<Points> parts(std::size_t link, const Mat3& frame) const;

 private:
  Pose pose(const std::string& link) const;

  const UrdfParts& parts_;
  std::vector<Pose> poses_;
  Pose to_tcp_;
};

// What parts span: their inner faces (y) at x = `section`, and all of them.
struct PartsExtent {
  Interval inner, x, y, z;
};
PartsExtent extent_of(const std::vector<Points>& parts, double section);

}  // namespace probe::stage
