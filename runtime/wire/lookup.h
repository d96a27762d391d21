// From a host's name to addresses, in time: the system's own look-up knows no deadline and can take
// minutes where a name server is silent.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/wire/duration.h"
#include "runtime/wire/endpoint.h"

namespace probe::wire {

struct Address {
  std::string ip;  // numeric: "127.0.0.1", "::1"
  std::uint16_t port = 0;
  bool operator==(const Address&) const = default;
};

// Blocks as long as it likes. A failure's message is what was found wrong ("Host not found").
using Resolver =
    std::function<Result<std::vector<Address>>(const std::string& host, const std::string& port)>;
Result<std::vector<Address>> system_resolver(const std::string& host, const std::string& port);

// At least one address, in `time`, which is what is left of the `stated` one that messages name.
// The resolver runs on a thread of its own, which is left behind when the time is over: it then
// ends whenever the resolver returns. Fails (kPolicy, where = HOST:PORT) naming what was wrong. No
// resolver: the system's.
Result<std::vector<Address>> look_up(const Endpoint& server, Duration time, Duration stated,
                                     const Resolver& resolver = {});

}  // namespace probe::wire
