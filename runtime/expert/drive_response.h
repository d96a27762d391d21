// How far each joint gets towards its target within one control step, learnt from what it did.
// Drives are stiff and damped, so the distance left shrinks by a factor of the joint's own; a servo
// that knows the factors can ask for a target beyond and have all joints arrive together, which
// keeps the tool on its line.
#pragma once

#include <array>
#include <span>

#include "runtime/robot/kinematics.h"

namespace probe::expert {

class DriveResponse {
 public:
  DriveResponse() { reset(); }
  void reset();

  // A joint stood at `before`, had the target `target` for one control step, and stands at `after`.
  void learn(std::span<const double> before, std::span<const double> target,
             std::span<const double> after);

  // 1 / the share of the way joint j covers in a control step, from 1 up.
  double lead(std::size_t j) const;

 private:
  struct Sums {
    double product = 0, square = 0;
  };
  std::array<Sums, robot::kMaxChainJoints> sums_;
};

}  // namespace probe::expert
