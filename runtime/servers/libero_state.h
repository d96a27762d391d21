// The state that policies trained on LIBERO were trained with: eight numbers, as openpi's,
// OpenVLA's and LeRobot's clients make them of robosuite's observation.
#pragma once

#include <vector>

#include "runtime/base/result.h"
#include "runtime/policy/policy.h"

namespace probe::servers {

// Of a Panda: the tool's place in the world (m), the turn of its hand as an axis times an angle
// (rad), both fingers (m, the second counts downwards). The angle is 2 acos(w) of the quaternion as
// MuJoCo has it, which has no one sign: it goes beyond pi, and does so in most of the benchmark's
// own starts. `base`: the robot's in the world. Fails for a robot of other than seven joints and
// two fingers.
Result<std::vector<double>> libero_state(const policy::Proprioception& measured, const Pose& base);

}  // namespace probe::servers
