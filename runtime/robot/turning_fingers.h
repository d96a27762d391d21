// Fingers that turn as they close, as data: where their faces are at some openings of the gripper.
// Fingers that slide need none of it, as all of them moves alike.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace probe::robot {

// Both fingers at one opening, in the grasp frame; m. Where they differ, the mean.
struct FingersAt {
  static constexpr std::size_t kHeights = 12;
  double openness = 0;   // of the gripper, 0 closed .. 1 open
  double gap_half = 0;   // between the faces that hold things, from the middle; the least of it
  double tip_below = 0;  // fingertips past the tool centre point
  // Inner and outer faces from the middle, from the fingertips up to the palm at even heights.
  std::array<double, kHeights> inner{}, outer{};
};

// From closed to open, each wider than the one before.
using TurningFingers = std::vector<FingersAt>;

// Between two of them; at the ends beyond. Of fingers that turn only.
FingersAt fingers_at(const TurningFingers& fingers, double openness);
double openness_of_gap(const TurningFingers& fingers, double gap_half);

// The inner face from the middle, at x from the tool centre point towards the tips: m. Far below
// the tips there is none.
double inner_face(const FingersAt& at, double palm_above, double x);
// The outer one; at the tips and beyond theirs.
double outer_face(const FingersAt& at, double palm_above, double x);

}  // namespace probe::robot
