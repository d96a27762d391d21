// A policy test against servers that each do one thing wrong.
#include "runtime/servers/conformance.h"
#include "runtime/base/json.h"

#include <doctest/doctest.h>

#include "tests/servers/python_server.h"

namespace probe::servers {
namespace {

Conformance tested(const std::string& habit, const std::string& options = "",
                   const std::string& chunk = "4") {
  const test::PythonServer server("openpi_server.py",
                                  {"openpi", "seen=" + habit, "chunk=" + chunk});
  REQUIRE_MESSAGE(!server.port().empty(), "Debian's python3-websockets is installed");
  const auto choice =
      choose_server(Protocol::kOpenpi, "//127.0.0.1:" + server.port() + "?" + options);
  REQUIRE_MESSAGE(choice.ok(), to_text(choice.failure()));
  const auto result = test_server(*choice);
  REQUIRE_MESSAGE(result.ok(), to_text(result.failure()));
  return *result;
}

const Check& check_of(const Conformance& result, const std::string& name) {
  for (const Check& check : result.checks) {
    if (check.name == name) return check;
  }
  FAIL("no check `" << name << "` in\n" << to_text(result));
  return result.checks.front();
}

// The verdict and, where there is one, the first line that would mend it.
std::string verdict_of(const Conformance& result, const std::string& name) {
  const Check& check = check_of(result, name);
  return std::string(to_word(check.verdict)) + (check.fix.empty() ? "" : ": " + check.fix[0]);
}

}  // namespace

TEST_CASE("a server that does as its profile says passes every check") {
  const Conformance result = tested("fine");
  CHECK_FALSE(result.is_wrong());
  for (const Check& check : result.checks) {
    CAPTURE(check.name);
    CAPTURE(check.found);
    CHECK(check.verdict == Verdict::kFine);
  }
  CHECK(result.queries == 11);  // of at most 20
  CHECK(result.median_s > 0);
  const auto json = Json::parse(to_json(result));
  CHECK(json["checks"].size() == result.checks.size());
  CHECK(json["checks"][0]["verdict"] == "fine");
}

TEST_CASE("each thing that is wrong is found, with the field that mends it") {
  CHECK(verdict_of(tested("unit"), "gripper") == "wrong: action.gripper = unit");
  CHECK(verdict_of(tested("fine", "action.gripper=unit&action.threshold=0.5"), "gripper") ==
        "fine");
  CHECK(verdict_of(tested("inverted", "action.gripper=unit&action.threshold=0.5"), "gripper") ==
        "wrong: action.gripper = signed");
  CHECK(verdict_of(tested("inverted"), "polarity") == "warning: action.gripper = signed_inverted");
  CHECK(verdict_of(tested("inverted", "action.gripper=signed_inverted"), "polarity") == "fine");
  // An open hand with nothing to take makes no step.
  CHECK(verdict_of(tested("fine", "action.gripper=step"), "gripper") ==
        "warning: action.gripper = unit");
  CHECK(verdict_of(tested("euler"), "rotation") == "wrong: action.rotation = euler");
  CHECK(verdict_of(tested("euler", "action.rotation=euler"), "rotation") == "fine");
  CHECK(verdict_of(tested("vector", "action.rotation=euler"), "rotation") ==
        "wrong: action.rotation = vector");
  CHECK(verdict_of(tested("normalised"), "translation").find("wrong: action.normalised = bound") ==
        0);
  CHECK(verdict_of(tested("fine", "chunk.length=2"), "chunk") == "wrong: chunk.length = 4");
  CHECK(verdict_of(tested("fine", "chunk.use=8"), "chunk") == "wrong: chunk.use = 4");
  CHECK(verdict_of(tested("fine", "", "50"), "chunk") == "warning: chunk.use = 4");
}

TEST_CASE("noise, and answers that ignore what they are asked, are found") {
  CHECK(verdict_of(tested("noise"), "sameness") == "warning");
  CHECK(verdict_of(tested("deaf"), "instruction") == "warning");
  CHECK(verdict_of(tested("deaf"), "picture") == "fine");
  CHECK(verdict_of(tested("blind"), "picture") == "warning");
}

TEST_CASE("answers that are none end the test with what came") {
  const Conformance six = tested("six");
  CHECK(six.is_wrong());
  CHECK(check_of(six, "answer").found.find("got an array 4 x 6") != std::string::npos);
  CHECK(check_of(tested("nan"), "answer").found.find("is not a number") != std::string::npos);
  const Conformance keys = tested("fine", "image=first%20-%3E%20observation/rgb");
  CHECK(check_of(keys, "answer").found.find("AssertionError") != std::string::npos);
}

TEST_CASE("a server that is not there is a finding") {
  const auto choice = choose_server(Protocol::kOpenpi, "//127.0.0.1:1");
  REQUIRE(choice.ok());
  const auto result = test_server(*choice);
  REQUIRE(result.ok());
  CHECK(verdict_of(*result, "connection") == "wrong");
  CHECK(check_of(*result, "connection").found.find("Connection refused") != std::string::npos);
}

}  // namespace probe::servers
