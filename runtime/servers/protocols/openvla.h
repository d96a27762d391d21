// The messages of OpenVLA's protocol: POST /act with JSON, arrays as json_numpy writes them, in two
// forms named by the profile's field `dialect`: plain, and "encoded", a JSON text inside a JSON
// text.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/servers/transport.h"

namespace probe::servers {

// {image keys, the state where the profile has one, the instruction, "unnorm_key" where the profile
// has one}.
Result<std::string> openvla_request(const Profile& profile, const Request& request);

// The actions of an answer's body, in either form. Fails (kPolicy) on the text "error", which
// is all that OpenVLA says when it fails, and on what to_actions refuses.
Result<std::vector<RawAction>> openvla_actions(std::string_view body);

}  // namespace probe::servers
