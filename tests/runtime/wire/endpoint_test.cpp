#include "runtime/wire/endpoint.h"

#include <doctest/doctest.h>

namespace probe::wire {

TEST_CASE("a server's name, port, path and options are read") {
  const auto e = parse_endpoint("//gpu7:8000/v1?profile=pi0%2Fbridge&model=/m", "1");
  REQUIRE(e.ok());
  CHECK(e->host == "gpu7");
  CHECK(e->port == "8000");
  CHECK(e->path == "/v1");
  CHECK(e->options.at("profile") == "pi0/bridge");
  CHECK(e->options.at("model") == "/m");
  CHECK(e->name() == "gpu7:8000");
}

TEST_CASE("a missing port is the protocol's own, and brackets hold an IPv6 address") {
  CHECK(parse_endpoint("//localhost", "8000")->port == "8000");
  const auto six = parse_endpoint("//[::1]:9", "8000");
  REQUIRE(six.ok());
  CHECK(six->host == "::1");
  CHECK(six->port == "9");
}

TEST_CASE("what is no address is named with what it lacks") {
  CHECK(parse_endpoint("localhost:8000", "1").failure().message ==
        "`localhost:8000`: a server is written `//HOST:PORT`");
  CHECK(parse_endpoint("//:8000", "1").failure().message == "`//:8000`: a host is missing");
  CHECK(parse_endpoint("//h:99999", "1").failure().message ==
        "`//h:99999`: `99999` is no port from 1 to 65535");
  CHECK_FALSE(parse_endpoint("//h:8000x", "1").ok());
  CHECK_FALSE(parse_endpoint("//h?a", "1").ok());
  CHECK_FALSE(parse_endpoint("//h?a=1&a=2", "1").ok());
  CHECK_FALSE(parse_endpoint("//h?a=%2", "1").ok());
  CHECK_FALSE(parse_endpoint("//[::1", "1").ok());
}

TEST_CASE("a secret is refused, never repeated, and told where it belongs") {
  for (const char* text :
       {"//h?key=hunter2", "//h?profile=p&Api-Key=hunter2", "//h?api_token=hunter2",
        "//me:hunter2@h:80", "h?a=1&password=hunter2", "//h?token=hunter2&b"}) {
    const auto refused = parse_endpoint(text, "1");
    REQUIRE_FALSE(refused.ok());
    CHECK_MESSAGE(refused.failure().message.find("hunter2") == std::string::npos, text);
  }
  CHECK(parse_endpoint("//h?key=hunter2", "1").failure().message ==
        "a secret, `key`, would be stored with every result: give it in the environment, as "
        "VLAPROBE_API_KEY");
  CHECK(parse_endpoint("//h?prompt.key=task", "1").ok());
  CHECK(parse_endpoint("//h?image=first -> a/b 8x8", "1").ok());
  CHECK_FALSE(parse_endpoint("//h/a b", "1").ok());
  CHECK_FALSE(parse_endpoint("//h/\r\nX: y", "1").ok());
}

}  // namespace probe::wire
