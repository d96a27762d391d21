// What openpi's protocol and its dialects share: MessagePack over a WebSocket on which the server
// speaks first. A text message is an error, except where it answers a reset.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/servers/transport.h"
#include "runtime/wire/endpoint.h"
#include "runtime/wire/websocket.h"

namespace probe::servers {

// One connection and its messages. Failures are those of Transport.
class OpenpiConnection {
 public:
  explicit OpenpiConnection(wire::Endpoint server) : server_(std::move(server)) {}

  // Connects and reads the metadata that every server begins with.
  Result<wire::Value> open(const Profile& profile, const Deadlines& deadlines);
  void close() { socket_.reset(); }

  // A map with pictures, which a profile's keys could make overwrite each other.
  Result<wire::Value> ask(wire::Map map, wire::Duration timeout);
  Result<wire::Value> exchange(const wire::Value& request, wire::Duration timeout);

  Status send(const wire::Value& request, wire::Duration timeout);
  Result<wire::Value> receive(wire::Duration timeout);
  // Fails (kAnswered) where a message that nothing asked for is there, or comes within `wait`.
  Status listen(wire::Duration wait);
  // Also of texts.
  Result<wire::Message> receive_message(wire::Duration timeout);

 private:
  Failure explained(Failure failure, wire::Duration connect_time) const;

  wire::Endpoint server_;
  std::unique_ptr<wire::WebSocket> socket_;
};

void append_images(const Request& request, wire::Map* map);

// The map's keys for `policy test`.
std::vector<std::string> metadata_remarks(const wire::Value& metadata);

}  // namespace probe::servers
