// TLS under WebSocket and HTTP: which certificates are taken, and what is said of the others.
#include "runtime/wire/tls.h"

#include <doctest/doctest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "runtime/wire/http.h"
#include "runtime/wire/websocket.h"
#include "tests/servers/python_server.h"

namespace probe::wire {
namespace {

using namespace std::chrono_literals;

// The authority's file of one server; gone with this object.
struct AuthorityFile {
  std::string path = (std::filesystem::temp_directory_path() /
                      ("vlaprobe_ca_" + std::to_string(getpid()) + ".pem"))
                         .string();
  ~AuthorityFile() { std::filesystem::remove(path); }
};

std::vector<std::string> front(const AuthorityFile& ca, std::vector<std::string> words) {
  words.insert(words.begin(), "ca=" + ca.path);
  return words;
}

Endpoint at(const test::PythonServer& server, Tls tls, const char* host = "127.0.0.1") {
  REQUIRE_MESSAGE(!server.port().empty(), "Debian's packages of .ci/packages.txt are installed");
  return {host, server.port(), "/", {}, std::move(tls)};
}

// What a WebSocket at a server with such a certificate says, trusting its authority or the system.
Result<std::unique_ptr<WebSocket>> opened(const std::string& cert, bool trusts_authority,
                                          bool accepts_any = false,
                                          const char* host = "127.0.0.1") {
  const AuthorityFile ca;
  const test::PythonServer server("tls_front.py",
                                  front(ca, {"cert=" + cert, "websocket_server.py"}));
  return WebSocket::connect(at(server, {true, trusts_authority ? ca.path : "", accepts_any}, host));
}

Failure refusal(const std::string& cert, bool trusts_authority = true) {
  const auto socket = opened(cert, trusts_authority);
  REQUIRE_FALSE(socket.ok());
  CHECK(socket.failure().code == Fault::kAnswered);  // not tried again
  return socket.failure();
}

std::span<const std::uint8_t> bytes_of(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

}  // namespace

TEST_CASE("a WebSocket over TLS carries a picture's worth of bytes whole and in order") {
  const AuthorityFile ca;
  const test::PythonServer server("tls_front.py", front(ca, {"websocket_server.py"}));
  for (const char* host : {"127.0.0.1", "localhost"}) {
    const auto socket = WebSocket::connect(at(server, {true, ca.path, false}, host));
    REQUIRE_MESSAGE(socket.ok(), to_text(socket.failure()));
    REQUIRE((*socket)->send(bytes_of("echo"), 5s).ok());
    for (const std::size_t size : {0U, 1U, 125U, 16384U, 65536U, 921600U}) {
      Bytes sent(size);
      for (std::size_t i = 0; i < size; ++i) sent[i] = static_cast<std::uint8_t>(i * 7 + size);
      REQUIRE((*socket)->send(sent, 5s).ok());
      const auto back = (*socket)->receive(5s);
      REQUIRE_MESSAGE(back.ok(), to_text(back.failure()));
      CHECK(back->bytes == sent);
    }
  }
}

TEST_CASE("HTTP goes over TLS") {
  const AuthorityFile ca;
  const test::PythonServer server("tls_front.py", front(ca, {"http_server.py"}));
  HttpRequest post{"POST", "/echo", std::string(300000, 'x'), "application/json", {}};
  const auto answer = http_exchange(at(server, {true, ca.path, false}), post);
  REQUIRE_MESSAGE(answer.ok(), to_text(answer.failure()));
  CHECK(answer->status == 200);
  const auto plain = http_exchange(at(server, {}), post);
  REQUIRE_FALSE(plain.ok());
  CHECK(plain.failure().message ==
        "the server speaks TLS: its address begins with https://127.0.0.1:" + server.port());
}

TEST_CASE("SSL_CERT_FILE names authorities in place of the system's") {
  const AuthorityFile ca;
  const test::PythonServer server("tls_front.py", front(ca, {"websocket_server.py"}));
  REQUIRE(setenv("SSL_CERT_FILE", ca.path.c_str(), 1) == 0);
  const auto socket = WebSocket::connect(at(server, {true, "", false}));
  unsetenv("SSL_CERT_FILE");
  CHECK_MESSAGE(socket.ok(), (socket.ok() ? "" : to_text(socket.failure())));
}

TEST_CASE("a certificate that does not fit is refused for what is wrong with it") {
  CHECK(refusal("good", false).message ==
        "the certificate is signed by none of the system's authorities; trust its signer by "
        "?ca=FILE or SSL_CERT_FILE, or accept any with --insecure");
  CHECK(refusal("self", false).message ==
        "the certificate is self-signed; trust its signer by ?ca=FILE or SSL_CERT_FILE, or accept "
        "any with --insecure");
  CHECK(refusal("self").message == "the certificate is self-signed; --insecure accepts any");
  const std::string stranger = refusal("stranger").message;
  CHECK(stranger.starts_with("the certificate is signed by none of `"));
  CHECK(stranger.ends_with("`; --insecure accepts any"));
  CHECK(refusal("expired").message ==
        "the certificate expired on 2021-05-06 07:08 UTC; --insecure accepts any");
  CHECK(refusal("early").message ==
        "the certificate is not valid before 2120-01-01 00:00 UTC: is this machine's clock right?");
  CHECK(refusal("elsewhere").message ==
        "the certificate is for gpu.example, 10.1.2.3, not for 127.0.0.1; --insecure accepts any");
  CHECK(refusal("purpose").message.starts_with("the certificate does not fit: "));
  const auto named = opened("elsewhere", true, false, "localhost");
  REQUIRE_FALSE(named.ok());
  CHECK(named.failure().message ==
        "the certificate is for gpu.example, 10.1.2.3, not for localhost; --insecure accepts any");
}

TEST_CASE("any certificate is taken where that is asked for") {
  for (const char* cert :
       {"good", "self", "stranger", "expired", "early", "elsewhere", "purpose"}) {
    CAPTURE(cert);
    const auto socket = opened(cert, false, true);
    CHECK_MESSAGE(socket.ok(), (socket.ok() ? "" : to_text(socket.failure())));
  }
}

TEST_CASE("a file that holds no certificates is named") {
  const test::PythonServer server("websocket_server.py");
  const auto absent = WebSocket::connect(at(server, {true, "/no/such.pem", false}));
  REQUIRE_FALSE(absent.ok());
  CHECK(absent.failure().code == Fault::kUsage);
  CHECK(to_text(absent.failure()) == "/no/such.pem: `ca` names no file");
  const auto text = WebSocket::connect(at(server, {true, "/etc/hostname", false}));
  REQUIRE_FALSE(text.ok());
  CHECK(text.failure().code == Fault::kUsage);
  CHECK(to_text(text.failure())
            .starts_with("/etc/hostname: holds no certificates (PEM) that can be read: "));
}

TEST_CASE("an answer that is too large is named so over TLS, and at once") {
  const AuthorityFile ca;
  const test::PythonServer server("tls_front.py", front(ca, {"websocket_server.py"}));
  WebSocketOptions options;
  options.largest_message = std::size_t{1} << 20;
  const auto socket = WebSocket::connect(at(server, {true, ca.path, false}), options);
  REQUIRE_MESSAGE(socket.ok(), to_text(socket.failure()));
  REQUIRE((*socket)->send(bytes_of("huge"), 5s).ok());
  const auto begin = std::chrono::steady_clock::now();
  const auto message = (*socket)->receive(20s);
  REQUIRE_FALSE(message.ok());
  CHECK(message.failure().message == "an answer of more than 1 MiB");
  CHECK(std::chrono::steady_clock::now() - begin < 5s);
}

TEST_CASE("servers that want a client's certificate, or speak an old TLS, are told") {
  const AuthorityFile ca;
  const auto said = [&](std::vector<std::string> words, bool over_http) {
    words.push_back(over_http ? "http_server.py" : "websocket_server.py");
    const test::PythonServer server("tls_front.py", front(ca, words));
    const Endpoint server_at = at(server, {true, ca.path, false});
    if (over_http) {
      const auto answer = http_exchange(server_at, {"GET", "/echo", "", "", {}});
      return answer.ok() ? std::string() : answer.failure().message;
    }
    const auto socket = WebSocket::connect(server_at);
    return socket.ok() ? std::string() : socket.failure().message;
  };
  for (const bool over_http : {false, true}) {
    CAPTURE(over_http);
    CHECK(said({"fault=mutual", "alerts=yes"}, over_http) ==
          "the server wants a certificate of its clients (mutual TLS), and vlaprobe has none");
    CHECK(said({"fault=mutual12", "alerts=yes"}, over_http)
              .starts_with("the server ended TLS's handshake: it may want a certificate of its "
                           "clients (mutual TLS)"));
    CHECK(said({"fault=old", "alerts=yes"}, over_http) ==
          "the server speaks an older TLS than 1.2, the oldest that is taken");
    // Without a word, as Python's servers do.
    CHECK(said({"fault=mutual"}, over_http) ==
          "the server closed the connection right behind TLS's handshake: does it want a "
          "certificate of its clients (mutual TLS)? vlaprobe has none");
    CHECK(said({"fault=reset", "alerts=yes"}, over_http) ==
          "the server closed the connection right behind TLS's handshake: does it want a "
          "certificate of its clients (mutual TLS)? vlaprobe has none");
    for (const char* fault : {"fault=mutual12", "fault=old"}) {
      CHECK(said({fault}, over_http) ==
            "opening TLS: the server closed the connection; does it speak TLS, of 1.2 or newer and "
            "without a certificate of its clients?");
    }
  }
}

TEST_CASE("a server that sends elsewhere is not followed, and where to is said without a secret") {
  const test::PythonServer server("http_server.py");
  Endpoint moved = at(server, {});
  moved.path = "/moved";
  const auto socket = WebSocket::connect(moved);
  REQUIRE_FALSE(socket.ok());
  CHECK(socket.failure().code == Fault::kAnswered);
  CHECK(socket.failure().message ==
        "opening a WebSocket: answered with HTTP status 302, which sends to "
        "`wss://gpu.example/policy`: let the address name that");
  const auto answer = http_exchange(moved, {"GET", "/moved", "", "", {}});
  REQUIRE_MESSAGE(answer.ok(), to_text(answer.failure()));
  CHECK(sent_elsewhere(static_cast<unsigned>(answer->status), answer->location) ==
        ", which sends to `https://gpu.example/policy`: let the address name that");
  CHECK(sent_elsewhere(200, "https://gpu.example/") == "");
}

TEST_CASE("plain servers behind wss and TLS servers behind ws are told") {
  const AuthorityFile ca;
  const test::PythonServer plain("websocket_server.py");
  const auto wss = WebSocket::connect(at(plain, {true, "", true}));
  REQUIRE_FALSE(wss.ok());
  CHECK(wss.failure().message ==
        "what listens there does not speak TLS: its address begins with ws:// or http://");
  const test::PythonServer tls("tls_front.py", front(ca, {"websocket_server.py"}));
  const auto ws = WebSocket::connect(at(tls, {}));
  REQUIRE_FALSE(ws.ok());
  CHECK(ws.failure().message ==
        "the server speaks TLS: its address begins with wss://127.0.0.1:" + tls.port());
  CHECK(ws.failure().code == Fault::kAnswered);
}

TEST_CASE("a handshake that hangs ends in time") {
  const AuthorityFile ca;
  const test::PythonServer server("tls_front.py", front(ca, {"fault=hang", "websocket_server.py"}));
  WebSocketOptions quick;
  quick.connect_timeout = 300ms;
  const auto begin = std::chrono::steady_clock::now();
  const auto socket = WebSocket::connect(at(server, {true, "", true}), quick);
  REQUIRE_FALSE(socket.ok());
  CHECK(socket.failure().message == "opening TLS took more than 0.3 s");
  CHECK(std::chrono::steady_clock::now() - begin < 3s);
}

TEST_CASE("a connection that is cut is told from one that TLS ended") {
  const AuthorityFile ca;
  for (const bool is_cut : {true, false}) {
    const test::PythonServer server(
        "tls_front.py", front(ca, {is_cut ? "fault=cut" : "fault=none", "websocket_server.py"}));
    const auto socket = WebSocket::connect(at(server, {true, ca.path, false}));
    REQUIRE_MESSAGE(socket.ok(), to_text(socket.failure()));
    REQUIRE((*socket)->send(bytes_of("gone"), 5s).ok());
    const auto message = (*socket)->receive(5s);
    REQUIRE_FALSE(message.ok());
    CHECK(message.failure().message ==
          (is_cut ? "the server went away without ending TLS" : "the server went away"));
  }
}

TEST_CASE("an answer that only its connection's end ends must not be cut") {
  const AuthorityFile ca;
  for (const bool is_cut : {true, false}) {
    const test::PythonServer server(
        "tls_front.py", front(ca, {is_cut ? "fault=cut" : "fault=none", "http_server.py"}));
    const auto answer =
        http_exchange(at(server, {true, ca.path, false}), {"GET", "/endless", "", "", {}});
    CHECK(answer.ok() == !is_cut);
    if (!answer)
      CHECK(answer.failure().message ==
            "the server closed the connection in the middle of its answer");
  }
}

}  // namespace probe::wire
