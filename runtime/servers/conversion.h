// Between the simulator's conventions and a server's, as its profile says: prompt, state, actions.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/policy/policy.h"
#include "runtime/servers/profile.h"
#include "runtime/servers/transport.h"

namespace probe::servers {

std::string to_prompt(const Profile& profile, std::string_view prompt);

// Fails (kPolicy) when the robot has too few joints for the layout, or as many other numbers
// than the profile has statistics.
Result<std::vector<double>> to_state(const Profile& profile,
                                     const policy::Proprioception& measured);

// The same numbers in another layout, not normalised.
Result<std::vector<double>> to_state(const Profile& profile, StateLayout layout,
                                     const policy::Proprioception& measured);

// What the profile's statistics and scales make of a server's numbers, in m, rad and the gripper's
// range.
RawAction denormalised(const Profile& profile, const RawAction& raw);

// Denormalised, the rotation as a rotation vector, the gripper -1 .. +1. Numbers that already are
// ours come back bit for bit. Fails (kPolicy), naming the field that would be at fault, on a
// shift or turn above the profile's limits and on a gripper's number far outside its range.
// Of an absolute pose these limits hold for what it changes.
struct ArmNow {
  Pose target;         // of the controller, base frame
  Vec3 tool_measured;  // the tool centre point's position, base frame
};
Result<policy::Action> to_action(const Profile& profile, const RawAction& raw,
                                 const ArmNow& arm = {});

}  // namespace probe::servers
