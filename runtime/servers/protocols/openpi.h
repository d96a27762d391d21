// openpi's protocol (MessagePack over WebSocket) and its two dialects. What differs from dialect to
// dialect is the order of messages, the form of a request and where the actions stand in an answer.
#pragma once

#include <memory>
#include <string>

#include "runtime/base/result.h"
#include "runtime/servers/transport.h"

namespace probe::servers {

// {image keys, state key, prompt key} -> {"actions"}. Sends the API key, if there is one. Servers
// keep nothing between requests, so episodes are not announced.
Result<std::unique_ptr<Transport>> make_openpi(const Profile& profile,
                                               const wire::Endpoint& server);

// INT-ACT's: {"new_model_path"} once a run, {"reset"} before and after each episode, the state
// inside
// {"agent": {"eef_pos"}}. Fails (kUsage) without the option `model`, because its servers
// begin without one.
Result<std::unique_ptr<Transport>> make_intact(const Profile& profile,
                                               const wire::Endpoint& server);

// RoboArena's: {"endpoint": "infer" | "reset"}, and a server that says which pictures it wants and
// what its actions are.
Result<std::unique_ptr<Transport>> make_roboarena(const Profile& profile,
                                                  const wire::Endpoint& server);

}  // namespace probe::servers
