#include "runtime/studio/gate.h"

#include <doctest/doctest.h>

#include <set>

using namespace probe;

namespace {

const studio::Gate kGate{"0123456789abcdef0123456789abcdef", "4000"};

wire::Visit ours(const std::string& path = "") {
  return {"GET", "/" + kGate.token + "/" + path, "127.0.0.1:4000", "", "", false};
}

int status_of(const wire::Visit& visit) {
  const auto page = kGate.refuse(visit);
  if (!page) return 200;
  CHECK(page->body.starts_with("vlaprobe studio: "));
  CHECK(page->body.find(kGate.token) == std::string::npos);
  return page->status;
}

}  // namespace

TEST_CASE("whoever has the whole address is answered") {
  CHECK(status_of(ours()) == 200);
  CHECK(status_of(ours("page.js?x=1")) == 200);
  wire::Visit by_name = ours();
  by_name.host = "localhost:4000";
  CHECK(status_of(by_name) == 200);
  CHECK(kGate.path("/" + kGate.token + "/page.js?x=1") == "page.js");
  CHECK(kGate.path("/" + kGate.token) == "");
  CHECK(kGate.path("/" + kGate.token + "/") == "");
}

TEST_CASE("without the token, with a part of it or with another nothing is answered") {
  for (const std::string& target :
       {std::string("/"), std::string(""), std::string("/page.js"), "/" + kGate.token.substr(1),
        "/" + kGate.token + "0/", "/" + kGate.token.substr(0, 31) + "0/",
        "//" + kGate.token + "/", "/x/" + kGate.token + "/", "/?" + kGate.token,
        "http://127.0.0.1:4000/" + kGate.token + "/", "*" + kGate.token}) {
    CAPTURE(target);
    wire::Visit visit = ours();
    visit.target = target;
    CHECK(status_of(visit) == 403);
  }
}

TEST_CASE("a name that was made to mean this machine is refused (DNS rebinding)") {
  for (const char* host : {"", "127.0.0.1", "127.0.0.1:4001", "evil.example:4000", "localhost",
                           "127.0.0.1:4000.evil.example", "[::1]:4000", "0.0.0.0:4000"}) {
    CAPTURE(host);
    wire::Visit visit = ours();
    visit.host = host;
    CHECK(status_of(visit) == 421);
  }
}

TEST_CASE("a page of another origin is refused, with the token as well") {
  for (const char* origin : {"null", "http://evil.example", "https://127.0.0.1:4000",
                             "http://127.0.0.1:4001", "http://127.0.0.1:4000.evil.example",
                             "http://localhost"}) {
    CAPTURE(origin);
    wire::Visit visit = ours("live");
    visit.is_upgrade = true;
    visit.origin = origin;
    CHECK(status_of(visit) == 403);
  }
  wire::Visit own = ours("live");
  own.is_upgrade = true;
  own.origin = "http://127.0.0.1:4000";
  CHECK(status_of(own) == 200);
  own.site = "cross-site";
  CHECK(status_of(own) == 403);
}

TEST_CASE("nothing is answered but GET") {
  for (const char* method : {"POST", "PUT", "DELETE", "OPTIONS", "TRACE", ""}) {
    wire::Visit visit = ours();
    visit.method = method;
    CHECK(status_of(visit) == 405);
  }
}

TEST_CASE("tokens are 32 digits and differ") {
  std::set<std::string> seen;
  for (int i = 0; i < 100; ++i) {
    const auto token = studio::make_token();
    REQUIRE(token);
    CHECK(token->size() == 32);
    CHECK(token->find_first_not_of("0123456789abcdef") == std::string::npos);
    seen.insert(*token);
  }
  CHECK(seen.size() == 100);
}
