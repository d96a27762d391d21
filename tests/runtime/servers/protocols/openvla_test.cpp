// OpenVLA's requests as text, and its client against a server of the same rules.
#include "runtime/servers/protocols/openvla.h"
#include "runtime/base/json.h"

#include <doctest/doctest.h>

#include "tests/runtime/servers/asking.h"

namespace probe::servers {
using namespace probe::policy;
namespace {

using test::PythonServer;

constexpr const char* kOurs = "&action.rotation=vector&action.gripper=signed&action.threshold=none";

Request small_request() {
  Request request;
  request.prompt = "put \"it\" down";
  request.images.push_back({"image", wire::array_u8({1, 2, 3}, {0, 1, 2, 3, 4, 5})});
  return request;
}

}  // namespace

TEST_CASE("an OpenVLA request is json_numpy's text, plain or encoded") {
  Profile profile;
  profile.prompt_key = "instruction";
  const std::string plain =
      "{\"image\": {\"__numpy__\": \"AAECAwQF\", \"dtype\": \"|u1\", \"shape\": [1, 2, 3]}, "
      "\"instruction\": \"put \\\"it\\\" down\"}";
  CHECK(openvla_request(profile, small_request()).value() == plain);
  profile.unnorm_key = "bridge_orig";
  CHECK(openvla_request(profile, small_request())
            .value()
            .ends_with(", \"unnorm_key\": \"bridge_orig\"}"));
  profile.unnorm_key.clear();
  profile.dialect = "encoded";
  const auto encoded = Json::parse(openvla_request(profile, small_request()).value());
  CHECK(encoded.size() == 1);
  CHECK(encoded["encoded"] == plain);
}

TEST_CASE("OpenVLA's answers are read in both forms, and its `error` is one") {
  const std::string action =
      R"({"__numpy__": "mpmZmZmZuT8AAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAA8D8=", )"
      R"("dtype": "<f8", "shape": [7]})";
  const std::vector<RawAction> expected{{0.1, 0, 0, 0, 0, 0, 1}};
  REQUIRE_MESSAGE(openvla_actions(action).ok(), openvla_actions(action).failure().message);
  CHECK(*openvla_actions(action) == expected);
  CHECK(*openvla_actions(Json(action).dump()) == expected);
  CHECK(*openvla_actions("[0.1, 0, 0, 0, 0, 0, 1]") == expected);
  CHECK(openvla_actions("\"error\"")
            .failure()
            .message.starts_with("the server failed and answers \"error\""));
  CHECK_FALSE(openvla_actions("\"hello\"").ok());
  CHECK(openvla_actions("{\"detail\": \"x\"}").failure().message ==
        "expected actions of 7 numbers, an array 7 or N x 7; got a map with keys detail");
}

TEST_CASE("OpenVLA's two forms are spoken, a chunk too") {
  for (const char* dialect : {"plain", "encoded"}) {
    CAPTURE(std::string(dialect));
    const PythonServer server("openvla_server.py", {"bridge=1", "chunk=2"});
    const auto policy =
        policy_at("openvla", server, "&chunk.length=any&dialect=" + std::string(dialect));
    AskingPicture picture;
    must_begin(*policy);
    for (const double expected : {0.0, 0.001, 0.002}) {
      CHECK(must_act(*policy, picture.observation()) == Action{expected, 0, 0, 0, 0, 0, 1});
    }
  }
}

TEST_CASE("an OpenVLA server without the statistics asked for says error, and so do we") {
  const PythonServer server("openvla_server.py", {"unnorm_key=bridge_orig"});
  AskingPicture picture;
  const auto without = policy_at("openvla", server, kOurs);
  must_begin(*without);
  CHECK(without->act(picture.observation())
            .failure()
            .message.starts_with("the server failed and answers \"error\"; "));
  const auto with = policy_at("openvla", server, "&profile=openvla_bridge");
  must_begin(*with);
  CHECK(must_act(*with, picture.observation())[6] == 1);
}

TEST_CASE("another path than /act is asked where the address has one, and a status is told") {
  const PythonServer server("openvla_server.py");
  auto policy =
      make_policy("openvla://127.0.0.1:" + server.port() + "/predict?timeout.wait_s=0.05");
  REQUIRE(policy.ok());
  must_begin(**policy);
  AskingPicture picture;
  CHECK((*policy)->act(picture.observation()).failure().message ==
        "`POST /predict` is answered with status 404: {\"detail\": \"Not Found\"}");
  CHECK(make_policy("openvla://h?dialect=yaml").failure().message ==
        "the `dialect` of an OpenVLA server is plain or encoded, not `yaml`");
}

}  // namespace probe::servers
