// Boxes of parts of fixtures, as both checks of their ways look at them and speak of them.
#pragma once

#include <string>

#include "compiler/geometry/box_runs.h"
#include "compiler/geometry/travel.h"
#include "compiler/model/model.h"

namespace probe::sema {

// " when `cabinet.top` stands at 4cm": all joints that carry the part of a box of everywhere().
std::string when(const Fixture& fixture, const Travel& travel, const PartBox& box);

}  // namespace probe::sema
