// Poses for the tool to go through, one after another: when the next one is its goal, and when it
// comes no nearer.
#pragma once

#include <vector>

#include "runtime/base/geometry.h"

namespace probe::expert {

class ToolWay {
 public:
  enum class State { kGoing, kThere, kStuck };
  // m: how near the last one is met, and the one before it, which leads into it.
  void begin(std::vector<Pose> way, double near, double before_last);
  // Call once a decision.
  State advance(const Pose& tool);
  const Pose& goal() const { return way_[next_]; }
  bool is_last() const { return next_ + 1 >= way_.size(); }
  bool is_next_last() const { return next_ + 2 >= way_.size(); }

 private:
  std::vector<Pose> way_;
  std::size_t next_ = 0;
  double near_ = 0.004, before_last_ = 0.010;
  int still_ = 0, steps_ = 0;
  Pose before_;
};

}  // namespace probe::expert
