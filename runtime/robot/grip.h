// How far a gripper is open, from the positions of its fingers' joints.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/robot/urdf.h"

namespace probe::robot {

// Limits of the first finger's joint, rad or m, from the one where the gripper is closed to the one
// where it is open; the others' are taken to be alike. Both 0 where there are no fingers.
struct FingerRange {
  double closed = 0, open = 0;
  // 0 closed .. 1 open: the mean position within the limits; 1 without fingers.
  double openness(std::span<const double> fingers) const;
};

// Fails (kUrdf) on a name that is not there and on a joint that has no limits to move within.
// `opens_up`: whether positions grow as the gripper opens.
Result<FingerRange> finger_range(const RobotModel& model, std::span<const std::string> joints,
                                 bool opens_up = true);

}  // namespace probe::robot
