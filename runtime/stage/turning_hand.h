// Fingers that turn, measured at many positions of their joints: what a hand whose fingers do not
// move along one line is to whoever grasps with it.
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "runtime/robot/robot.h"
#include "runtime/stage/posed_hand.h"

namespace probe::stage {

// Whether both fingers' joints turn.
bool fingers_turn(const robot::Robot& robot);

// The position of the finger joints at which the fingers face one another best, however little that
// is; nullopt where they have no range. Of two fingers that turn.
std::optional<double> facing_grip(const robot::Robot& robot, const UrdfParts& parts,
                                  const robot::Tree& tree);

// Fills in what the fingers are in the grasp frame; `links` first that of the finger on the side
// of +y. The palm is known. False where they leave no opening.
bool measure_turning(const robot::Robot& robot, const UrdfParts& parts, const robot::Tree& tree,
                     const std::array<std::size_t, 2>& links, const Mat3& frame,
                     robot::HandShape* shape);

}  // namespace probe::stage
