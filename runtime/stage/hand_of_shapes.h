// The room that a hand takes, measured from the collision shapes of its links: for robots that
// nobody measured by hand.
#pragma once

#include <optional>

#include "runtime/robot/robot.h"
#include "runtime/stage/assets.h"

namespace probe::stage {

// Of a robot with two fingers that open along one line, one to each side of the tool centre point,
// or turn and face one another somewhere on their way; nullopt for any other. `robot` has its
// fingers, its control and its joints.
std::optional<robot::Hand> hand_of_shapes(const robot::Robot& robot, const UrdfParts& parts);

}  // namespace probe::stage
