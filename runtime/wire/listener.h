// The servers' side of the wires that clients here speak: what reference servers and played
// transcripts stand on. One thread a connection; knows no protocol.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/wire/value.h"

namespace probe::wire {

// One message, as it goes over a WebSocket; ZeroMQ and HTTP have no texts of another kind.
struct Frame {
  bool is_text = false;
  Bytes bytes;
  bool operator==(const Frame&) const = default;
};

Frame text_frame(std::string_view text);

// One peer's half of a conversation. Called from one thread at a time.
class Speaker {
 public:
  struct Reply {
    std::vector<Frame> frames;
    // Why the connection is closed after them (a WebSocket's code 1011); none: it stays.
    std::optional<std::string> close = std::nullopt;
  };

  virtual ~Speaker() = default;
  // What is sent before anything is asked.
  virtual std::vector<Frame> greet() { return {}; }
  virtual Reply answer(const Frame& asked) = 0;
};
using MakeSpeaker = std::function<std::unique_ptr<Speaker>()>;

// Listens on an own thread until it goes, and then has ended every connection.
class Listener {
 public:
  virtual ~Listener() = default;
  virtual std::string port() const = 0;
};

// A server's certificate, with those between it and an authority behind it, and its key, both PEM.
struct TlsFiles {
  std::string certificate, key;
  bool is_on() const { return !certificate.empty(); }
};

// What a GET is answered with; nothing: that there is no such page. From several threads at once.
struct Page {
  int status = 200;
  std::string type, body;
  std::vector<std::pair<std::string, std::string>> headers = {};
};
using AnswerPage = std::function<std::optional<Page>(const std::string& target)>;

// `address` is numeric; port "0" is any free one. Fail (kUsage) where nobody may listen there, and
// where certificate and key cannot be shown. A WebSocket's connection has a speaker of its own; GET
// /healthz is answered with OK, and others by `page`. ZeroMQ's REP socket, HTTP, where every POST
// is a message, and gRPC, where every call is one (grpc.h), have one for all.
Result<std::unique_ptr<Listener>> listen_websocket(const std::string& address,
                                                   const std::string& port, MakeSpeaker make,
                                                   const TlsFiles& tls = {},
                                                   AnswerPage page = nullptr);
Result<std::unique_ptr<Listener>> listen_zmq(const std::string& address, const std::string& port,
                                             MakeSpeaker make);
Result<std::unique_ptr<Listener>> listen_http(const std::string& address, const std::string& port,
                                              MakeSpeaker make, const TlsFiles& tls = {});
Result<std::unique_ptr<Listener>> listen_grpc(const std::string& address, const std::string& port,
                                              MakeSpeaker make);

}  // namespace probe::wire
