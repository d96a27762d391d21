#include "runtime/wire/http.h"

#include <doctest/doctest.h>

#include <string>

#include "tests/servers/python_server.h"

namespace probe::wire {
namespace {

using namespace std::chrono_literals;

std::string failure_at(const std::string& path) {
  static const test::PythonServer server("http_server.py");
  HttpRequest request;
  request.path = path;
  HttpOptions options;
  options.timeout = 500ms;
  options.largest_body = 1 << 20;
  const auto response = http_exchange({"127.0.0.1", server.port(), "/", {}}, request, options);
  REQUIRE_FALSE(response.ok());
  CHECK(response.failure().where == "127.0.0.1:" + server.port());
  return response.failure().message;
}

}  // namespace

TEST_CASE("a body goes there and comes back, whatever its size") {
  const test::PythonServer server("http_server.py");
  REQUIRE_FALSE(server.port().empty());
  const Endpoint endpoint{"127.0.0.1", server.port(), "/", {}};
  for (const std::size_t size : {1U, 1000U, 1300000U}) {
    HttpRequest request{"POST", "/echo", std::string(size, 'x'), "application/json", {}};
    const auto response = http_exchange(endpoint, request);
    REQUIRE_MESSAGE(response.ok(), to_text(response.failure()));
    CHECK(response->status == 200);
    CHECK(response->body == "POST application/json " + request.body);
  }
  const auto get = http_exchange(endpoint, {"GET", "/echo", "", "", {}});
  REQUIRE(get.ok());
  CHECK(get->body == "GET none ");
  const auto chunked = http_exchange(endpoint, {"GET", "/json?\"error\"", "", "", {}});
  REQUIRE(chunked.ok());
  CHECK(chunked->body == "\"error\"");
}

TEST_CASE("another status than 200 is an answer") {
  const test::PythonServer server("http_server.py");
  const auto response =
      http_exchange({"127.0.0.1", server.port(), "/", {}}, {"GET", "/error", "", "", {}});
  REQUIRE(response.ok());
  CHECK(response->status == 500);
  CHECK(response->body == "Traceback: ValueError");
}

TEST_CASE("each way of not answering over HTTP has its words") {
  CHECK(failure_at("/slow") == "no answer in 0.5 s");
  CHECK(failure_at("/partial") == "the server closed the connection in the middle of its answer");
  CHECK(failure_at("/closes") == "the server closed the connection without an answer");
  CHECK(failure_at("/huge") == "an answer of more than 1 MiB");
  CHECK(failure_at("/claims") == "an answer of more than 1 MiB");
  CHECK(failure_at("/garbage").starts_with("the answer is no HTTP ("));
  CHECK(failure_at("/header").starts_with("the answer is no HTTP ("));
  CHECK(failure_at("/chunk") == "the answer is no HTTP (a line of more than 256 KiB)");
  CHECK(failure_at("/trailer") == "the answer is no HTTP (a line of more than 256 KiB)");
}

TEST_CASE("an HTTP server that is not there is named") {
  const auto refused = http_exchange({"127.0.0.1", "1", "/", {}}, {});
  REQUIRE_FALSE(refused.ok());
  CHECK(to_text(refused.failure()) == "127.0.0.1:1: connecting: Connection refused");
}

}  // namespace probe::wire
