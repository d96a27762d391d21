// Parts of a robot by the names that its URDF gives them.
#pragma once

#include "compiler/names/context.h"

namespace probe::sema {

// P0201 unless the robot's URDF, where it could be read, has the link.
void check_link(Context& context, const Spelled& link, const Robot& robot);

// Whether the joint, or one that mimics it, is above one of the robot's fingers. False where the
// description could not be read.
bool moves_finger(const Robot& robot, std::string_view joint);

}  // namespace probe::sema
