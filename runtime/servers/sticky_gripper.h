// From an opening that is said at every step to how far a gripper is to go, as SimplerEnv's policies
// of the Google robot do it: one switch is held for some steps. Knows nothing of servers.
#pragma once

#include <optional>

namespace probe::servers {

// What an answer's opening is measured against.
enum class StickyRule {
  kNone,
  kLast,    // the answer before (SimplerEnv's Octo and OpenVLA, Magma's evaluation)
  kSwitch,  // that of the last switch, at first of the first answer (SpatialVLA's, LeRobot's pi0)
  kHalf,    // half way, times two (open-pi-zero's)
};

// Of one episode.
class StickyGripper {
 public:
  StickyGripper(StickyRule rule, int steps) : rule_(rule), steps_(steps) {}

  void reset();
  // `openness`: 0 closed .. 1 open, as answered. How far to go: +1 all the way open, -1 closed. A
  // change of more than half is held for `steps` answers, itself among them; any other is done as it
  // is. The first answer is a change of nothing, but for kHalf.
  double step(double openness);

 private:
  StickyRule rule_;
  int steps_;
  std::optional<double> against_;
  double held_ = 0;
  int left_ = 0;  // steps for which it is held, 0: it is not
};

}  // namespace probe::servers
