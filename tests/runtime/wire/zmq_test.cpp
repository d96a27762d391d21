#include "runtime/wire/zmq.h"

#include <doctest/doctest.h>

#include <string>
#include <string_view>
#include <thread>

#include "tests/servers/python_server.h"

namespace probe::wire {
namespace {

using namespace std::chrono_literals;

std::span<const std::uint8_t> bytes_of(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

std::unique_ptr<ZmqRequester> requester(const std::string& port, std::size_t largest = 64 << 20) {
  auto made = ZmqRequester::create({"127.0.0.1", port, "/", {}}, {500ms, largest});
  REQUIRE(made.ok());
  return std::move(made).value();
}

std::string failure_of(ZmqRequester& server, std::string_view message, Duration timeout) {
  const auto answer = server.ask(bytes_of(message), timeout);
  REQUIRE_FALSE(answer.ok());
  return answer.failure().message;
}

}  // namespace

TEST_CASE("a picture's worth of bytes comes back over ZeroMQ") {
  const test::PythonServer server("zmq_server.py");
  REQUIRE_MESSAGE(!server.port().empty(), "python3-zmq is installed");
  const auto socket = requester(server.port());
  for (const std::size_t size : {5U, 255U, 256U, 921600U}) {
    const std::string text = "echo:" + std::string(size, 'x');
    const auto answer = socket->ask(bytes_of(text), 5s);
    REQUIRE_MESSAGE(answer.ok(), to_text(answer.failure()));
    CHECK(std::string(answer->begin(), answer->end()) == text);
  }
}

TEST_CASE("after a late answer the next question has its own") {
  const test::PythonServer server("zmq_server.py");
  const auto socket = requester(server.port());
  CHECK(failure_of(*socket, "slow", 200ms) == "no answer in 0.2 s");
  const auto answer = socket->ask(bytes_of("echo:two"), 5s);
  REQUIRE_MESSAGE(answer.ok(), to_text(answer.failure()));
  CHECK(std::string(answer->begin(), answer->end()) == "echo:two");
}

TEST_CASE("a ZeroMQ server that dies or floods is told from one that is slow") {
  test::PythonServer server("zmq_server.py");
  const auto socket = requester(server.port(), 1 << 20);
  CHECK(failure_of(*socket, "huge", 5s) ==
        "the server closed the connection before it answered: it went away, does not speak "
        "ZeroMQ, or its answer has more than 1 MiB");
  CHECK(failure_of(*socket, "parts", 5s) == "an answer in several parts, where one was expected");
  REQUIRE(socket->ask(bytes_of("echo"), 5s).ok());
  server.stop();
  const std::string gone = failure_of(*socket, "echo", 5s);
  CHECK(gone.starts_with("the server "));
  CHECK(failure_of(*socket, "echo", 5s) == "connecting: nobody listens there");
}

TEST_CASE(
    "a ZeroMQ server that was exchanged between two questions is not asked as if it were one") {
  std::string port;
  std::unique_ptr<ZmqRequester> socket;
  {
    const test::PythonServer server("zmq_server.py");
    port = server.port();
    socket = requester(port);
    REQUIRE(socket->ask(bytes_of("echo"), 5s).ok());
  }
  const test::PythonServer other("zmq_server.py", {port});
  REQUIRE(other.port() == port);
  std::this_thread::sleep_for(300ms);  // ZeroMQ has connected again by itself
  CHECK(failure_of(*socket, "echo", 5s) == "the server went away after its last answer");
  CHECK(socket->ask(bytes_of("echo"), 5s).ok());
}

TEST_CASE("an answer in parts that do not end is given up at the limit") {
  const test::PythonServer server("zmq_server.py", {"flood"});
  const auto socket = requester(server.port(), 4 << 20);
  CHECK(failure_of(*socket, "echo", 10s) == "an answer of more than 4 MiB");
}

TEST_CASE("what listens without speaking ZeroMQ is named") {
  {
    const test::PythonServer server("zmq_server.py", {"raw"});
    const std::string message = failure_of(*requester(server.port()), "echo", 500ms);
    CHECK_MESSAGE(message.find("not speak ZeroMQ") != std::string::npos, message);
  }
  const test::PythonServer server("zmq_server.py", {"silent"});
  CHECK(failure_of(*requester(server.port()), "echo", 500ms) ==
        "something listens there that does not speak ZeroMQ");
}

}  // namespace probe::wire
