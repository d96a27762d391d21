// The messages of vla-eval's protocol 1, as pure functions: {"type", "payload", "seq",
// "timestamp"} in MessagePack, arrays with text keys, pictures encoded or not.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "runtime/base/result.h"
#include "runtime/servers/profile.h"
#include "runtime/servers/transport.h"
#include "runtime/wire/value.h"

namespace probe::servers::vlaeval {

struct Message {
  std::string type;  // "hello", "observation", "action", "episode_start", "episode_end", "error"
  wire::Value payload;
  std::int64_t seq = 0;
};

// `timestamp` in seconds since 1970.
wire::Bytes to_bytes(const Message& message, double timestamp);

// Fails (kPolicy) naming the field that is missing or of another kind.
Result<Message> from_bytes(std::span<const std::uint8_t> bytes);

enum class PictureCoding { kRaw, kPng, kJpeg };

// What is observed, as SimplerEnv's benchmark there sends it: pictures by key, the instruction, the
// task's name, and with `send_state` the state and the poses of base and tool, m and wxyz. The base
// frame is the world to whoever relates the two poses.
Result<wire::Value> observation(const Profile& profile, const Request& request,
                                std::string_view task, PictureCoding coding, bool send_state);

}  // namespace probe::servers::vlaeval
