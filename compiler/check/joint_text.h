// Where joints stand, as both checks of the ways of fixtures' parts say it.
#pragma once

#include <string>

#include "compiler/geometry/travel.h"
#include "compiler/model/model.h"

namespace probe::sema {

// " when `cabinet.top` stands at 4cm": all joints that carry the part of a box of everywhere().
std::string when_joints_stand(const Fixture& fixture, const Travel& travel, const PartBox& box);

}  // namespace probe::sema
