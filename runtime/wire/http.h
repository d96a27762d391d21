// One HTTP/1.1 exchange, over TLS where the address asks for it, on a connection of its own, so
// that a server that was restarted between two exchanges is not noticed.
#pragma once

#include <cstddef>
#include <string>
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
};

// Whatever status the server answers with is a response. Fails (kPolicy) naming the server
// and what happened: unknown host, refused, no answer in time, closed before or in the middle of
// its answer, more than the largest body, no HTTP. `server.path` is not used.
Result<HttpResponse> http_exchange(const Endpoint& server, const HttpRequest& request,
                                   const HttpOptions& options = {});

}  // namespace probe::wire
