#include "runtime/servers/sticky_gripper.h"

#include <cmath>

namespace probe::servers {

void StickyGripper::reset() {
  against_.reset();
  held_ = 0;
  left_ = 0;
}

double StickyGripper::step(double openness) {
  double change = 0;
  if (rule_ == StickyRule::kHalf) {
    change = 2 * openness - 1;
  } else if (against_) {
    change = openness - *against_;
  }
  if (rule_ == StickyRule::kLast || !against_) against_ = openness;
  if (std::abs(change) > 0.5 && left_ == 0) {
    held_ = change;
    left_ = steps_;
    against_ = openness;
  }
  if (left_ == 0) return change;
  --left_;
  return held_;
}

}  // namespace probe::servers
