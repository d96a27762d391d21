// vla-eval's protocol 1 (MessagePack over WebSocket): a hello in which the server says what it
// wants to be sent, episodes that are announced, one action an observation.
#pragma once

#include <memory>

#include "runtime/base/result.h"
#include "runtime/servers/transport.h"

namespace probe::servers {

// The options `pictures` (raw, png, jpeg; else raw to this machine and png to others) and
// `send_state` (true, false; else what the server asks for). Fails (kUsage) on other values.
Result<std::unique_ptr<Transport>> make_vlaeval(const Profile& profile,
                                                const wire::Endpoint& server);

}  // namespace probe::servers
