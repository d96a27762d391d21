// What the gripper's number of an action asks for: -1 closed .. +1 open. Header only.
#pragma once

#include <algorithm>

namespace probe::robot {

// How far open that is, 0 closed .. 1 open; numbers beyond the ends mean the ends.
inline double openness_of_command(double command) {
  return 0.5 * (std::clamp(command, -1.0, 1.0) + 1.0);
}
inline double command_of_openness(double openness) {
  return std::clamp(2 * openness - 1, -1.0, 1.0);
}

// Where the fingers' joints are to go, rad or m, between what closed and open are for them.
inline double finger_target(double closed, double open, double command) {
  return closed + openness_of_command(command) * (open - closed);
}

}  // namespace probe::robot
