#include "runtime/servers/protocols/openpi_connection.h"

#include <algorithm>

#include "runtime/servers/api_key.h"
#include "runtime/wire/http.h"
#include "runtime/wire/msgpack.h"

namespace probe::servers {
Result<wire::Value> OpenpiConnection::open(const Profile& profile, const Deadlines& deadlines) {
  wire::WebSocketOptions options;
  options.connect_timeout = deadlines.connect;
  options.largest_message = static_cast<std::size_t>(profile.largest_answer) << 20;
  if (const std::string key = api_key(); !key.empty()) {
    options.headers.emplace_back("Authorization", "Api-Key " + key);
  }
  auto socket = wire::WebSocket::connect(server_, options);
  if (!socket) return explained(socket.failure(), deadlines.connect);
  socket_ = std::move(*socket);
  PROBE_ASSIGN(wire::Value metadata, receive(deadlines.connect));
  if (metadata.as<wire::Map>() == nullptr) {
    return answered("expected the server's metadata first, a map; got " + wire::describe(metadata));
  }
  return metadata;
}

Result<wire::Value> OpenpiConnection::ask(wire::Map map, wire::Duration timeout) {
  const wire::Value request(std::move(map));
  PROBE_TRY(check_distinct_keys(request));
  return exchange(request, timeout);
}

Result<wire::Value> OpenpiConnection::exchange(const wire::Value& request, wire::Duration timeout) {
  PROBE_TRY(send(request, timeout));
  return receive(timeout);
}

Status OpenpiConnection::send(const wire::Value& request, wire::Duration timeout) {
  if (!socket_) return bad("there is no connection");
  // It would be taken for this question's answer, and every answer after it be one too old.
  PROBE_TRY(listen(wire::Duration(0)));
  return socket_->send(wire::to_msgpack(request, wire::ArrayStyle::kBinKeys), timeout);
}

Status OpenpiConnection::listen(wire::Duration wait) {
  if (!socket_ || !socket_->awaits_message(wait)) return {};
  PROBE_ASSIGN(const wire::Value message, receive(wire::Duration(0)));
  return answered(std::string(kUnasked) + ": " + wire::describe(message));
}

Result<wire::Message> OpenpiConnection::receive_message(wire::Duration timeout) {
  if (!socket_) return bad("there is no connection");
  return socket_->receive(timeout);
}

Result<wire::Value> OpenpiConnection::receive(wire::Duration timeout) {
  PROBE_ASSIGN(const wire::Message message, receive_message(timeout));
  if (message.is_text) return answered("the server failed: " + last_lines(message.text()));
  auto value = wire::from_msgpack(message.bytes);
  if (!value) return answered(value.failure().message);
  return value;
}

// Where something listens that does not open a WebSocket, what its health page says of it.
Failure OpenpiConnection::explained(Failure failure, wire::Duration connect_time) const {
  if (failure.message.find("opening a WebSocket") == std::string::npos) return failure;
  const wire::Duration patience = std::min(connect_time, wire::Duration(2000));
  wire::HttpRequest health;
  health.path = "/healthz";
  const auto answer =
      wire::http_exchange(server_, health, {patience, patience, std::size_t{1} << 16});
  if (!answer) {
    failure.message += "; it does not answer /healthz either: busy, or no policy server";
  } else if (answer->status == 200 && answer->body.starts_with("OK")) {
    failure.message +=
        "; /healthz says OK, so a policy server is there: does it want another VLAPROBE_API_KEY?";
  } else {
    failure.message += "; /healthz is answered with HTTP " + std::to_string(answer->status) +
                       ": another kind of server?";
  }
  return failure;
}

void append_images(const Request& request, wire::Map* map) {
  for (const RequestImage& image : request.images) map->emplace_back(image.key, image.pixels);
}

std::vector<std::string> metadata_remarks(const wire::Value& metadata) {
  const auto* map = metadata.as<wire::Map>();
  if (map == nullptr || map->empty()) return {"metadata: none"};
  std::vector<std::string> lines;
  for (const auto& [key, value] : *map) {
    lines.push_back("metadata " + last_lines(key) + ": " + wire::describe(value));
  }
  return lines;
}

}  // namespace probe::servers
