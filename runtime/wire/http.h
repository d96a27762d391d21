// HTTP/1.1 exchanges, over TLS where the address asks for it: each on a connection of its own, so
// that a server that was restarted between two is not noticed, or many on one that is kept.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/wire/duration.h"
#include "runtime/wire/endpoint.h"
#include "runtime/wire/lookup.h"

namespace probe::wire {

struct HttpRequest {
  std::string method = "GET";  // or "POST"
  std::string path = "/";      // with a query if it has one
  std::string body;
  std::string content_type = "application/json";  // of a body
  std::vector<std::pair<std::string, std::string>> headers;
};

struct HttpOptions {
  Duration connect_timeout{10'000};
  Duration timeout{30'000};                          // from the first byte sent to the last read
  std::size_t largest_body = std::size_t{64} << 20;  // bytes that are read at most
  Resolver resolver = {};                            // of the host's name; none: the system's
};

struct HttpResponse {
  int status = 0;
  std::string body;
  std::string content_type = {};
  std::optional<std::string> retry_after = {};  // the field's value, as it came
  std::string location = {};                    // the field of that name
};

// Behind "answered with status 302": ", which sends to `PLACE`: ..."; empty for answers that send
// nowhere. Where a WebSocket was to be opened, PLACE is as its address is written.
std::string sent_elsewhere(unsigned status, std::string_view location, bool is_websocket = false);

// Whatever status the server answers with is a response. Fails (kPolicy) naming the server
// and what happened: unknown host, refused, no answer in time, closed before or in the middle of
// its answer, more than the largest body, no HTTP. `server.path` is not used.
Result<HttpResponse> http_exchange(const Endpoint& server, const HttpRequest& request,
                                   const HttpOptions& options = {});

struct HttpTalk;  // an open connection

// The same over one connection for as long as the server keeps it, which spares each exchange a
// handshake; one thread's. A kept connection that turns out to be closed before the first byte of
// an answer is replaced by a new one, once and unseen: a server may close what is idle at any time,
// and one that was restarted is not noticed here either.
class HttpConnection {
 public:
  explicit HttpConnection(Endpoint server, HttpOptions options = {});
  ~HttpConnection();
  Result<HttpResponse> exchange(const HttpRequest& request);
  // Whether the last exchange had a connection at all: else nobody was there.
  bool reached() const { return reached_; }

 private:
  Endpoint server_;
  HttpOptions options_;
  std::unique_ptr<HttpTalk> open_;  // null: the next exchange connects
  bool reached_ = false;
};

}  // namespace probe::wire
