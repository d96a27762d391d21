// The messages of Isaac-GR00T's protocol (MessagePack over ZeroMQ REQ/REP) in its three forms,
// named by the profile's field `dialect`: n1.6 (flat keys, answers with an info map), n1.6_nested
// (the same without the simulation wrapper) and n1.5 (one dimension less, no reset).
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/servers/transport.h"

namespace probe::servers {

enum class Gr00tForm { kN16, kN16Nested, kN15 };

// The observation of a "get_action". The state goes entry by entry under `state.key` and an
// entry's name: x, y, z, roll, pitch, yaw, pad, gripper.
wire::Value gr00t_observation(Gr00tForm form, const Profile& profile, const Request& request);

// An entry of a state: what it is called, and how many of its numbers it holds.
struct Gr00tState {
  std::string_view name;
  std::size_t count = 1;
};
// In the order of the numbers; none where GR00T is not sent such a layout.
std::span<const Gr00tState> gr00t_states(StateLayout layout);
// "video.image_0" is `image_0` in a map of its own in the nested form.
std::string gr00t_nested_image_key(std::string_view key);

// The actions of an answer: arrays x, y, z, roll, pitch, yaw and gripper of one length, with or
// without "action." before their names. Fails (kPolicy) on an error map, with what the server
// said, and on anything else.
Result<std::vector<RawAction>> gr00t_actions(const wire::Value& answer);

}  // namespace probe::servers
