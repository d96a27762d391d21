// What servers do wrong, for every protocol: the wait is bounded, the message says what happened,
// and the next episode works with the same policy.
#include <doctest/doctest.h>

#include <chrono>
#include <optional>

#include "tests/runtime/servers/asking.h"

namespace probe::servers {
using namespace probe::policy;
namespace {

using test::PythonServer;
using Clock = std::chrono::steady_clock;

// Answers may take 0.3 s, connections 0.3 s and no second attempt; nothing may take longer than
// both together and the machine's own delays.
constexpr const char* kQuick =
    "&timeout.connect_s=0.3&timeout.first_s=0.3&timeout.answer_s=0.3&timeout.wait_s=0.05"
    "&answer.largest_mib=1&action.rotation=vector&action.gripper=signed&action.threshold=none";
constexpr double kLongest = 4;  // s; a loaded machine's, ten times what is needed

struct Protocol {
  const char* name;
  const char* options;
};
constexpr Protocol kProtocols[] = {{"openpi", ""}, {"intact", "&model=/m"}, {"vlaeval", ""},
                                   {"gr00t", ""},  {"openvla", ""},         {"roboarena", ""},
                                   {"starvla", ""}};

std::unique_ptr<Policy> quick_policy(const Protocol& protocol, const std::string& port) {
  auto policy = make_policy(std::string(protocol.name) + "://127.0.0.1:" + port + "?" +
                            std::string(kQuick).substr(1) + protocol.options);
  REQUIRE_MESSAGE(policy.ok(), to_text(policy.failure()));
  return std::move(policy).value();
}

// One episode of one question. Nothing if it went well, else the whole text that a row would have.
std::optional<std::string> ask_once(Policy& policy, const std::string& prompt) {
  std::optional<std::string> failed;
  const auto begin = Clock::now();
  if (const auto begun = policy.begin(asking_start()); !begun) {
    failed = to_text(begun.failure());
  } else {
    AskingPicture picture;
    Observation seen = picture.observation();
    seen.prompt = prompt;
    if (const auto action = policy.act(seen); !action) failed = to_text(action.failure());
  }
  policy.end({});
  CHECK(std::chrono::duration<double>(Clock::now() - begin).count() < kLongest);
  return failed;
}

struct Fault {
  const char* name;
  // What the message holds after "127.0.0.1:PORT: ", in the order of kProtocols; null: the answer
  // is good.
  const char* says[std::size(kProtocols)];
};

constexpr const char* kEarlyEnd =
    "the server closed the connection before it answered: it went away";
constexpr const char* kNoActions =
    "expected actions of 7 numbers, an array 7 or N x 7; got a map with keys detail";

constexpr Fault kFaults[] = {
    {"slow", {nullptr, nullptr, nullptr, nullptr, nullptr, nullptr, nullptr}},
    {"never",
     {"no answer in 0.3 s", "no answer in 0.3 s", "no answer in 0.3 s", "no answer in 0.3 s",
      "no answer in 0.3 s", "no answer in 0.3 s", "no answer in 0.3 s"}},
    {"trickle",
     {"no answer in 0.3 s", "no answer in 0.3 s", "no answer in 0.3 s", "no answer in 0.3 s",
      "no answer in 0.3 s", "no answer in 0.3 s", "no answer in 0.3 s"}},
    {"gone",
     {"the server went away", "the server went away", "the server went away", kEarlyEnd,
      "the server closed the connection without an answer", "the server went away",
      "the server went away"}},
    {"closes",
     {"the server closed the connection (code 1011: out of memory)",
      "the server closed the connection (code 1011: out of memory)",
      "the server closed the connection (code 1011: out of memory)", kEarlyEnd,
      "the server closed the connection without an answer",
      "the server closed the connection (code 1011: out of memory)",
      "the server closed the connection (code 1011: out of memory)"}},
    {"half",
     {"the server went away", "the server went away", "the server went away", kEarlyEnd,
      "the server closed the connection in the middle of its answer", "the server went away",
      "the server went away"}},
    {"traceback",
     {"the server failed: Traceback (most recent call last): | File \"policy.py\", line 3, in "
      "infer | KeyError: 'x'",
      "the server failed: Traceback (most recent call last): | File \"policy.py\", line 3, in "
      "infer | KeyError: 'x'",
      "the server failed: observation_failed: KeyError: 'x'",
      "the server failed: Traceback (most recent call last): | File \"policy.py\", line 3, in "
      "infer | KeyError: 'x'",
      "`POST /act` is answered with status 500: Traceback (most recent call last): | File "
      "\"policy.py\", line 3, in infer | KeyError: 'x'",
      "the server failed: Traceback (most recent call last): | File \"policy.py\", line 3, in "
      "infer | KeyError: 'x'",
      "the server failed: Traceback (most recent call last): | File \"policy.py\", line 3, in "
      "infer | KeyError: 'x'"}},
    {"shape",
     {"expected actions of 7 numbers, an array 7 or N x 7; got an array 6 of <f8",
      "expected actions of 7 numbers, an array 7 or N x 7; got an array 6 of <f8",
      "expected actions of 7 numbers, an array 7 or N x 7; got an array 6 of <f8",
      "expected `action.y` among others, got a map with keys action.x",
      "expected actions of 7 numbers, an array 7 or N x 7; got an array 6 of <f8",
      "expected actions of 7 numbers, an array 7 or N x 7; got an array 6 of <f8",
      "expected actions of 7 numbers, an array 7 or N x 7; got an array 6 of <f8"}},
    {"nan",
     {"number 2 of action 1 of 1 is not a number", "number 2 of action 1 of 1 is not a number",
      "number 2 of action 1 of 1 is not a number", "number 2 of action 1 of 1 is not a number",
      "number 2 of action 1 of 1 is not a number", "number 2 of action 1 of 1 is not a number",
      "number 2 of action 1 of 1 is not a number"}},
    {"far",
     {"an action that shifts by 1000", "an action that shifts by 1000",
      "an action that shifts by 1000", "an action that shifts by 1000",
      "an action that shifts by 1000", nullptr, "an action that shifts by 1000"}},
    {"other",
     {"expected a map with `actions`, got a map with keys values",
      "expected an array, a list of arrays or a map with `actions` or `action`, got a map with "
      "keys values",
      "expected an action with `actions` or `action`, got a map with keys values",
      "expected `action.x` among others, got a map with keys values", kNoActions,
      "expected actions of 7 numbers, an array 7 or N x 7; got a map with keys values",
      "expected a map with `data`, a map with `actions`; got a map with keys values"}},
    // One of the many is taken for the answer, or there are too many at once.
    {"flood",
     {"", "", "", "expected `action.x` among others, got a map with keys values", kNoActions, "",
      ""}},
    {"huge",
     {"an answer of more than 1 MiB", "an answer of more than 1 MiB",
      "an answer of more than 1 MiB", kEarlyEnd, "an answer of more than 1 MiB",
      "an answer of more than 1 MiB", "an answer of more than 1 MiB"}},
    {"claims",
     {"an answer of more than 1 MiB", "an answer of more than 1 MiB",
      "an answer of more than 1 MiB", kEarlyEnd, "an answer of more than 1 MiB",
      "an answer of more than 1 MiB", "an answer of more than 1 MiB"}},
    {"garbage",
     {"not one MessagePack message: ", "not one MessagePack message: ",
      "not one MessagePack message: ", "not one MessagePack message: ", "no JSON but the text ",
      "not one MessagePack message: ", "not one MessagePack message: "}},
    {"raw",
     {"what came is no WebSocket message", "what came is no WebSocket message",
      "what came is no WebSocket message", "no answer in 0.3 s",
      "the answer is no HTTP (bad version)", "what came is no WebSocket message",
      "what came is no WebSocket message"}},
    {"empty",
     {"not a MessagePack message: it is empty", "not a MessagePack message: it is empty",
      "not a MessagePack message: it is empty", "not a MessagePack message: it is empty",
      "no JSON but an empty text", "not a MessagePack message: it is empty",
      "not a MessagePack message: it is empty"}},
};

constexpr Fault kConnectionFaults[] = {
    {"silent",
     {"opening a WebSocket took more than 0.3 s", "opening a WebSocket took more than 0.3 s",
      "opening a WebSocket took more than 0.3 s",
      "something listens there that does not speak ZeroMQ", "no answer in 0.3 s",
      "opening a WebSocket took more than 0.3 s", "opening a WebSocket took more than 0.3 s"}},
    {"hangs_up",
     {"opening a WebSocket: ", "opening a WebSocket: ", "opening a WebSocket: ",
      "something listens there that does not speak ZeroMQ",
      "the server closed the connection without an answer",
      "opening a WebSocket: ", "opening a WebSocket: "}},
    {"babbles",
     {"opening a WebSocket: ", "opening a WebSocket: ", "opening a WebSocket: ", "",
      "the answer is no HTTP (bad version)", "opening a WebSocket: ", "opening a WebSocket: "}},
    {"unavailable",
     {"opening a WebSocket: answered with HTTP status 503",
      "opening a WebSocket: answered with HTTP status 503",
      "opening a WebSocket: answered with HTTP status 503", "",
      "`POST /act` is answered with status 503: loading",
      "opening a WebSocket: answered with HTTP status 503",
      "opening a WebSocket: answered with HTTP status 503"}},
    {"speechless",
     {"no answer in 0.3 s", "no answer in 0.3 s", "no answer in 0.3 s", "no answer in 0.3 s",
      "no answer in 0.3 s", "no answer in 0.3 s", "no answer in 0.3 s"}},
    {"complains",
     {"the server failed: Traceback", "the server failed: Traceback",
      "the server failed: observation_failed: KeyError: 'x'", "the server failed: Traceback",
      nullptr, "the server failed: Traceback", "no answer in 0.3 s"}},
};

}  // namespace

TEST_CASE("a server's bad answer ends one episode, with its reason, and the next one works") {
  for (std::size_t p = 0; p < std::size(kProtocols); ++p) {
    const PythonServer server("fault_server.py", {kProtocols[p].name});
    const auto policy = quick_policy(kProtocols[p], server.port());
    for (const Fault& fault : kFaults) {
      CAPTURE(std::string(kProtocols[p].name));
      CAPTURE(std::string(fault.name));
      const auto failed = ask_once(*policy, "fault:" + std::string(fault.name));
      CHECK(failed.has_value() == (fault.says[p] != nullptr));
      if (failed && fault.says[p] != nullptr) {
        const std::string wanted = "127.0.0.1:" + server.port() + ": " + fault.says[p];
        CHECK_MESSAGE(failed->starts_with(wanted), *failed);
      }
      const auto after = ask_once(*policy, "put carrot on plate");
      CHECK_MESSAGE(!after, after.value_or(""));
    }
  }
}

TEST_CASE("what listens and is no policy server is told from one that is not there") {
  for (const Fault& fault : kConnectionFaults) {
    for (std::size_t p = 0; p < std::size(kProtocols); ++p) {
      if (kProtocols[p].name == std::string("intact")) continue;  // connects as openpi does
      CAPTURE(std::string(kProtocols[p].name));
      CAPTURE(std::string(fault.name));
      const PythonServer server("fault_server.py",
                                {kProtocols[p].name, "connect=" + std::string(fault.name)});
      const auto policy = quick_policy(kProtocols[p], server.port());
      const auto failed = ask_once(*policy, "put carrot on plate");
      if (fault.says[p] == nullptr) continue;
      REQUIRE(failed.has_value());
      const std::string wanted = "127.0.0.1:" + server.port() + ": " + fault.says[p];
      CHECK_MESSAGE(failed->starts_with(wanted), *failed);
    }
  }
}

TEST_CASE("a server that is killed costs one episode, and is met again when it is back") {
  for (const Protocol& protocol : kProtocols) {
    CAPTURE(std::string(protocol.name));
    auto server =
        std::make_unique<PythonServer>("fault_server.py", std::vector<std::string>{protocol.name});
    const std::string port = server->port();
    const auto policy = quick_policy(protocol, port);
    CHECK_FALSE(ask_once(*policy, "put carrot on plate"));
    server->stop();
    const auto lost = ask_once(*policy, "put carrot on plate");
    CHECK(lost.has_value());
    const auto absent = ask_once(*policy, "put carrot on plate");
    REQUIRE(absent.has_value());
    CHECK_MESSAGE(absent->starts_with("127.0.0.1:" + port + ": connecting: "), *absent);
    MESSAGE(std::string(protocol.name) << " killed: " << *lost << "; gone: " << *absent);
    server = std::make_unique<PythonServer>(
        "fault_server.py", std::vector<std::string>{protocol.name, "port=" + port});
    REQUIRE(server->port() == port);
    const auto back = ask_once(*policy, "put carrot on plate");
    CHECK_MESSAGE(!back, back.value_or(""));
  }
}

}  // namespace probe::servers
