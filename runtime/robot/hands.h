// Hands that were measured once, by the name of their robot's description. Others are measured from
// their collision shapes (stage/hand_of_shapes).
#pragma once

#include <optional>
#include <string_view>

#include "runtime/robot/robot.h"

namespace probe::robot {

std::optional<Hand> known_hand(std::string_view robot);

}  // namespace probe::robot
