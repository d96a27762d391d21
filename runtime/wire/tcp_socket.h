// A TCP connection for a library that wants a socket of the system, not one of Boost.Asio's.
#pragma once

#include "runtime/base/result.h"
#include "runtime/wire/duration.h"
#include "runtime/wire/endpoint.h"
#include "runtime/wire/lookup.h"

namespace probe::wire {

// A connected, non-blocking socket, which the caller owns. Fails (kPolicy) as the other wires do:
// unknown host, refused, not in time.
Result<int> connect_socket(const Endpoint& server, Duration timeout, const Resolver& resolver);

}  // namespace probe::wire
