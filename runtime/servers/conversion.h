// Between the simulator's conventions and a server's, as its profile says: prompt, state, actions.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/policy/policy.h"
#include "runtime/robot/action_space.h"
#include "runtime/robot/kinematics.h"
#include "runtime/servers/profile.h"
#include "runtime/servers/transport.h"

namespace probe::servers {

std::string to_prompt(const Profile& profile, std::string_view prompt);

// Fails (kPolicy) when the robot has too few joints for the layout, or as many other numbers
// than the profile has statistics. `base`: the robot's in the world, of a question that is of no
// scene the world's origin.
Result<std::vector<double>> to_state(const Profile& profile, const policy::Proprioception& measured,
                                     const Pose& base = {});

// The same numbers in another layout, not normalised.
Result<std::vector<double>> to_state(const Profile& profile, StateLayout layout,
                                     const policy::Proprioception& measured, const Pose& base = {});

// What the profile's statistics and scales make of a server's numbers, in m, rad and the gripper's
// range.
RawAction denormalised(const Profile& profile, const RawAction& raw);

struct ArmNow {
  Pose target;                                // of the controller, base frame
  Vec3 tool_measured;                         // the tool centre point's position, base frame
  std::span<const double> joints = {};        // measured, of the arm alone, rad
  const robot::Chain* chain = nullptr;        // of these joints; needed where actions name them
  const robot::ActionSpace* space = nullptr;  // the robot's; null: the tool's
};

// Denormalised, the rotation as a rotation vector, the gripper -1 .. +1. Numbers that already are
// ours come back bit for bit; joints become the pose that they bring the tool to, and go on as they
// are to a robot whose law takes them. Fails (kPolicy) where the numbers do not fit that law and,
// naming the field that would be at fault, on a shift or turn above the profile's limits, on
// joints far outside the robot's and on a gripper's number far outside its range. Of a pose, and of
// joints, the limits on shift and turn hold for what it changes.
Result<policy::Action> to_action(const Profile& profile, const RawAction& raw,
                                 const ArmNow& arm = {});

}  // namespace probe::servers
