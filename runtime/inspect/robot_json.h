// What a plan says of a task's robot, for `show`, `diff` and `dis`.
#pragma once

#include <string>

#include "runtime/base/json.h"
#include "runtime/plan/plan.h"

namespace probe::inspect {

// {name, control, hz, drives[], fingers[]}; where the law has numbers also law {kp[6], damping[6],
// output[6], null, uncouple, ramp, home[], grip {pace, stiffness, limit}} or, of joint_delta, {from
// "target" or "measured", most (rad or m; 0: any)}, where joints have them
// gears {joint: {friction, armature}}; where there is air, air {density, viscosity}. SI.
Json robot_of(const plan::Plan& plan, const plan::TaskRecord& task);

// "panda, osc_pose at 20 Hz".
std::string robot_text(const Json& robot);
// The law's numbers in a sentence without a verb; empty of a law without any.
std::string law_text(const Json& robot);

}  // namespace probe::inspect
