// One ZeroMQ REQ socket to a REP server over TCP. The only file that includes ZeroMQ's headers is
// zmq.cpp.
#pragma once

#include <cstddef>
#include <memory>
#include <span>

#include "runtime/base/result.h"
#include "runtime/wire/duration.h"
#include "runtime/wire/endpoint.h"
#include "runtime/wire/lookup.h"
#include "runtime/wire/value.h"

namespace probe::wire {

struct ZmqOptions {
  Duration connect_timeout{10'000};
  std::size_t largest_message = std::size_t{64} << 20;  // bytes that are read of one at most
  Resolver resolver = {};                               // of the host's name; none: the system's
};

class ZmqRequester {
 public:
  // Fails (kPolicy) only when the system gives no socket; the server is met by ask().
  static Result<std::unique_ptr<ZmqRequester>> create(const Endpoint& server,
                                                      const ZmqOptions& options = {});
  ~ZmqRequester();

  // Sends one message and waits for its answer, connecting first where that is needed. Fails
  // (kPolicy) naming the server and what happened: nobody there, no ZeroMQ, no answer in `timeout`,
  // closed before it answered or since its last answer, more than the largest message. After a
  // failure the next call begins with a new socket, because an unanswered REQ socket can never send
  // again.
  Result<Bytes> ask(std::span<const std::uint8_t> message, Duration timeout);

 private:
  class Sockets;
  explicit ZmqRequester(std::unique_ptr<Sockets> sockets);
  std::unique_ptr<Sockets> sockets_;
};

}  // namespace probe::wire
