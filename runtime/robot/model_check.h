// What a robot of this world can be: numbers that are finite, limits in order, masses and inertias
// that a body can have. Works on the plain model, whatever file it came from.
#pragma once

#include "runtime/base/result.h"
#include "runtime/robot/urdf.h"

namespace probe::robot {

// Failures have kUrdf and the model's path; the message names link or joint.
Status check_model(const RobotModel& model);

}  // namespace probe::robot
