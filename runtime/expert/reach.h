// Whether the arm follows a way of the tool by small steps, as the controller will ask for it.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "runtime/base/geometry.h"
#include "runtime/base/result.h"
#include "runtime/expert/path.h"
#include "runtime/robot/kinematics.h"
#include "runtime/robot/robot.h"

namespace probe::expert {

class Reach {
 public:
  // The arm's joints are all that move between the root and the tool centre point's link, in that
  // order; the chain ends in the hand's grasp frame. Copies what it needs. Fails (kPolicy) on
  // a robot without a hand that could grasp, and with the failures of Chain.
  static Result<Reach> create(const robot::Robot& robot);

  const robot::Chain& chain() const { return chain_; }
  const robot::Hand& hand() const { return hand_; }

  // How far a place for the grasp frame is beyond the arm, however its joints stand: m, 0 where
  // this bound does not tell. In the base frame.
  double beyond(const Vec3& place) const;

  // Whether the arm may be left so that the law does not bring it back to where it was: under one
  // that goes past limits, joints come to theirs on some ways.
  bool may_twist() const { return ignores_limits_; }

  // Follows straight lines from the tool's pose at `q` through the poses, a solution every 5 cm or
  // 0.3 rad, each from the one before. The joint positions at each pose; nothing as soon as one
  // fails.
  std::optional<std::vector<JointVector>> follow(std::span<const double> q,
                                                 std::span<const Pose> way) const;

 private:
  Reach(robot::Chain chain, const robot::Hand& hand, const Vec3& shoulder, double longest)
      : chain_(std::move(chain)), hand_(hand), shoulder_(shoulder), longest_(longest) {}
  // Joint positions that put the tool there, from those given.
  bool come_to(const Pose& at, std::span<double> joints) const;

  robot::Chain chain_;
  robot::Hand hand_;
  Vec3 shoulder_;   // the lowest point that no joint moves; base frame
  double longest_;  // m: of the arm stretched out from there
  // The law's own inverse kinematics goes past limits, where joints stay behind: it must not come
  // to them. Else ours, which turns off at them, as any law gets there that is told joints or
  // targets.
  bool ignores_limits_ = false;
};

}  // namespace probe::expert
