// Which joint of its URDF moves a part of a fixture.
#pragma once

#include <string>

#include "compiler/model/model.h"

namespace probe::sema {

// The nearest joint above a link that is not fixed; none of what stands still.
const robot::Joint* moving_joint(const robot::RobotModel& model, int link);

// Why a part without a joint of its own is not measured: nothing moves it, or it follows another.
std::string no_travel(const Fixture& fixture, const Fixture::Part& part);

}  // namespace probe::sema
