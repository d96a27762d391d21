// Everything that the hand could meet, as solids in three dimensions: for the ways to handles,
// where prisms from the ground up would leave no room. A convex part is wrapped by planes of 26
// directions of its own frame, which is exact for boxes along its axes.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "runtime/base/geometry.h"
#include "runtime/expert/path_residuals.h"
#include "runtime/policy/policy.h"
#include "runtime/robot/robot.h"

namespace probe::expert {

class Solid {
 public:
  static constexpr int kDirections = 26;
  static Solid around(std::span<const Vec3> vertices);

  // Of a point in the solid's frame: negative within; at most the true distance without.
  double distance(const Vec3& point) const;

  const Vec3& low() const { return low_; }
  const Vec3& high() const { return high_; }
  Vec3 center() const { return 0.5 * (low_ + high_); }
  Vec3 half() const { return 0.5 * (high_ - low_); }

 private:
  std::array<double, kDirections> reach_{};
  Vec3 low_ = Vec3::Zero(), high_ = Vec3::Zero();
};

// A part that stands elsewhere than it is seen.
struct MovedPart {
  int fixture = -1;
  Pose at;
};
// What is left out of a look: this solid of this fixture, or all of them where that is -1.
struct LeftOut {
  int fixture = -1, solid = -1;
};

// Base frame, as all of the expert. Solids of one body share its pose.
struct Surroundings {
  struct Body {
    Pose pose;
    std::vector<Solid> solids;
    int fixture = -1;  // of the privileged view; -1 for an object
    int carrier = -1;  // the fixture's part that an object stands in and goes with; -1 for none
  };
  std::vector<Body> bodies;
  double floor = 0;  // m, height of the surface

  // The least distance of balls in the tool's frame from all else and the floor, as far as it is
  // below `beyond`. `moved` stands where `at` says instead, and what stands in it goes along.
  double clearance(const Pose& tool, std::span<const Ball> balls, double beyond,
                   const MovedPart& moved = {}, const LeftOut& without = {}) const;
};
Surroundings surroundings_of(const policy::Privileged& view);

// The hand as balls in the grasp frame: fingers as thick as they are at each height, palm and
// wrist; `parted` m is how far the fingers' inner faces are from the middle.
struct HandBalls {
  std::vector<Ball> fingers, rest;
  std::vector<Ball> all() const;
};
HandBalls hand_balls(const robot::HandShape& hand, double parted);

}  // namespace probe::expert
