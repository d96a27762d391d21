#include "runtime/wire/websocket.h"

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

std::unique_ptr<WebSocket> connected(const test::PythonServer& server,
                                     const WebSocketOptions& options = {}) {
  REQUIRE_MESSAGE(!server.port().empty(), "python3-websockets is installed");
  auto socket = WebSocket::connect({"127.0.0.1", server.port(), "/", {}}, options);
  REQUIRE_MESSAGE(socket.ok(), to_text(socket.failure()));
  return std::move(socket).value();
}

std::string failure_in(const std::string& mode, const WebSocketOptions& options = {}) {
  const test::PythonServer server("websocket_server.py");
  const auto socket = connected(server, options);
  REQUIRE(socket->send(bytes_of(mode), 5s).ok());
  const auto message = socket->receive(500ms);
  REQUIRE_FALSE(message.ok());
  return message.failure().message;
}

}  // namespace

TEST_CASE("a picture's worth of bytes comes back whole and in order") {
  const test::PythonServer server("websocket_server.py");
  const auto socket = connected(server);
  REQUIRE(socket->send(bytes_of("echo"), 5s).ok());
  for (const std::size_t size : {0U, 1U, 125U, 126U, 65535U, 65536U, 921600U}) {
    Bytes sent(size);
    for (std::size_t i = 0; i < size; ++i) sent[i] = static_cast<std::uint8_t>(i * 7 + size);
    REQUIRE(socket->send(sent, 5s).ok());
    const auto back = socket->receive(5s);
    REQUIRE(back.ok());
    CHECK_FALSE(back->is_text);
    CHECK(back->bytes == sent);
  }
}

TEST_CASE("pings are answered while the simulator is busy") {
  const test::PythonServer server("websocket_server.py", {"pings"});
  const auto socket = connected(server);
  REQUIRE(socket->send(bytes_of("echo"), 5s).ok());
  std::this_thread::sleep_for(2500ms);
  REQUIRE(socket->send(bytes_of("still here"), 5s).ok());
  const auto back = socket->receive(5s);
  REQUIRE_MESSAGE(back.ok(), to_text(back.failure()));
  CHECK(back->text() == "still here");
}

TEST_CASE("fragments are one message") {
  const test::PythonServer server("websocket_server.py");
  const auto socket = connected(server);
  REQUIRE(socket->send(bytes_of("pieces"), 5s).ok());
  const auto message = socket->receive(5s);
  REQUIRE(message.ok());
  CHECK(message->text() == "one whole message");
}

TEST_CASE("a traceback is text, and the close after it has its code") {
  const test::PythonServer server("websocket_server.py");
  const auto socket = connected(server);
  REQUIRE(socket->send(bytes_of("traceback"), 5s).ok());
  const auto text = socket->receive(5s);
  REQUIRE(text.ok());
  CHECK(text->is_text);
  CHECK(text->text().find("ValueError") != std::string::npos);
  const auto end = socket->receive(5s);
  REQUIRE_FALSE(end.ok());
  CHECK(end.failure().message ==
        "the server closed the connection (code 1011: Internal server error.)");
  CHECK_FALSE(socket->send(bytes_of("more"), 1s).ok());
}

TEST_CASE("each way of not answering has its words") {
  CHECK(failure_in("closes") == "the server closed the connection (code 1000: enough)");
  CHECK(failure_in("never") == "no answer in 0.5 s");
  CHECK(failure_in("gone") == "the server went away");
  WebSocketOptions small;
  small.largest_message = 1 << 20;
  CHECK(failure_in("huge", small) == "an answer of more than 1 MiB");
}

TEST_CASE("no server, no host and no WebSocket are told apart") {
  std::string port;
  {
    test::PythonServer server("websocket_server.py");
    port = server.port();
  }
  const auto refused = WebSocket::connect({"127.0.0.1", port, "/", {}});
  REQUIRE_FALSE(refused.ok());
  CHECK(to_text(refused.failure()) == "127.0.0.1:" + port + ": connecting: Connection refused");
  const auto unknown = WebSocket::connect({"no-such-host.invalid", "8000", "/", {}});
  REQUIRE_FALSE(unknown.ok());
  CHECK(unknown.failure().message.starts_with("looking up the host: "));
}

TEST_CASE("a server that dies is noticed by the one who waits") {
  test::PythonServer server("websocket_server.py");
  const auto socket = connected(server);
  REQUIRE(socket->send(bytes_of("never"), 5s).ok());
  server.stop();
  const auto message = socket->receive(10s);
  REQUIRE_FALSE(message.ok());
  CHECK(message.failure().message == "the server went away");
}

}  // namespace probe::wire
