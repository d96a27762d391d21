// Why no hold of a part leads anywhere, as people read it.
#pragma once

#include <limits>
#include <span>
#include <string>

#include "runtime/expert/holds.h"
#include "runtime/expert/reach.h"

namespace probe::expert {

// What became of the holds that were looked at.
struct HoldLack {
  int holds = 0;    // with room for the hand
  int blocked = 0;  // of these, those to which no free way leads
  // m: how near inverse kinematics brings the tool to one of the others.
  double nearest = std::numeric_limits<double>::infinity();

  // A hold with a free way that the arm does not follow; `at` is where it begins.
  void add_out_of_reach(const Reach& reach, std::span<const double> joints, const Pose& at);
};

// "the arm does not reach it: the nearest hold stays 12.3 cm away"
std::string to_text(const HoldLack& lack, const HoldProblem& problem);

}  // namespace probe::expert
