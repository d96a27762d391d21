// One WebSocket connection (RFC 6455), over TLS where the address asks for it. An own thread reads,
// so that a server's pings are answered while the simulator works; the client itself never pings,
// because policy servers cannot answer during inference.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/wire/duration.h"
#include "runtime/wire/endpoint.h"
#include "runtime/wire/lookup.h"
#include "runtime/wire/value.h"

namespace probe::wire {

struct WebSocketOptions {
  Duration connect_timeout{10'000};
  std::size_t largest_message = std::size_t{64}
                                << 20;  // bytes that are read of one message at most
  std::vector<std::pair<std::string, std::string>> headers;  // of the upgrade request
  Resolver resolver = {};  // of the host's name; none: the system's
};

struct Message {
  bool is_text = false;
  Bytes bytes;
  std::string text() const { return {bytes.begin(), bytes.end()}; }
};

class WebSocket {
 public:
  // Fails (kPolicy) naming the server and what happened: unknown host, refused, no answer in
  // time, no WebSocket; kAnswered where the server is there and says no, or its certificate is
  // not trusted.
  static Result<std::unique_ptr<WebSocket>> connect(const Endpoint& server,
                                                    const WebSocketOptions& options = {});
  ~WebSocket();

  // One binary message, whole; returns when it is handed to the system.
  Status send(std::span<const std::uint8_t> bytes, Duration timeout);
  // The next message in order, fragments joined. Fails (kPolicy) when none comes in time,
  // when the server closes (with its code and reason) or sends more than the largest message. After
  // a failure only the destructor is of use.
  Result<Message> receive(Duration timeout);
  // Whether a message is there already: before a question, that is one which nothing asked for.
  bool has_message() const;
  // Whether one comes within `wait`; the connection stands either way.
  bool awaits_message(Duration wait) const;

 private:
  class Connection;
  explicit WebSocket(std::unique_ptr<Connection> connection);
  std::unique_ptr<Connection> connection_;
};

}  // namespace probe::wire
