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

TEST_CASE("a secret inside an option's value is refused as well, and never repeated") {
  for (const char* text : {"//h?model=https://u:hunter2@h/x",
                           "//h?model=https%3A%2F%2Fu%3Ahunter2%40h%2Fx",
                           "//h?model=https://hunter2@h",
                           "//h?model=https://h/x%3Ftoken=hunter2",
                           "//h?model=https://h/x%3Fa=1%26X-Amz-Signature=hunter2",
                           "//h?model=//u:hunter2@h/x",
                           "//h?model=https://h/x?api_key=hunter2",
                           "//h?model=/m%23access_token=hunter2",
                           "//h?model=https://g/%3Fto%3Dhttps%253A%252F%252Fu%253Ahunter2%2540h",
                           "//h?model=https://h/x?a=1&hf_token=hunter2",
                           "//h?model=https://u:a&hunter2@h/x",
                           "//h?model=s3://b/m?AWSAccessKeyId=hunter2",
                           "//h?hf_tok=hunter2",
                           "//h?model=https://h/x?sas=hunter2",
                           "//h?client_secret_value=hunter2",
                           "//h/act;token=hunter2",
                           "u:hunter2@h",
                           "//h?=hunter2",
                           "//h?model=https://h/x?code=hunter2",
                           "//h?model=https://h/x?subscription-key=hunter2",
                           "//h?model=https://h/x?sk=hunter2",
                           "//h?key%3Dhunter2=1",
                           "//h?a%=hunter2"}) {
    const auto refused = parse_endpoint(text, "1");
    REQUIRE_MESSAGE(!refused.ok(), text);
    CHECK_MESSAGE(to_text(refused.failure()).find("hunter2") == std::string::npos, text);
  }
  CHECK(parse_endpoint("//h?model=https://h/x?token=hunter2", "1").failure().message ==
        "a secret, `token`, in `model`, would be stored with every result: give it in the "
        "environment, as VLAPROBE_API_KEY");
  for (const char* text :
       {"//h?model=hf://org/octo@main", "//h?model=s3://b/k/model.pt", "//h?model=/ckpt/a@b/30000",
        "//h?unnorm_key=bridge_orig", "//h?model=/m%3Fstep=3", "//h?about=50%25 of it"}) {
    CHECK_MESSAGE(parse_endpoint(text, "1").ok(), text);
  }
}

}  // namespace probe::wire
