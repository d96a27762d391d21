// Both sides of a conversation, written down by whoever stands between: a listener of our own that
// hands every question on.
#include <mutex>

#include "runtime/servers/api_key.h"
#include "runtime/servers/conformance.h"
#include "runtime/servers/connecting.h"
#include "runtime/servers/protocol.h"
#include "runtime/servers/protocols/vlaeval_messages.h"
#include "runtime/servers/transcript.h"
#include "runtime/wire/grpc.h"
#include "runtime/wire/http.h"
#include "runtime/wire/websocket.h"
#include "runtime/wire/zmq.h"

namespace probe::servers {
namespace {

// What all connections write into.
struct Record {
  std::mutex mutex;
  Transcript transcript;

  std::size_t begin() {
    const std::lock_guard lock(mutex);
    transcript.connections.emplace_back();
    return transcript.connections.size() - 1;
  }
  void add(std::size_t connection, bool is_question, wire::Frame frame) {
    mask_key(frame.bytes, api_key());
    const std::lock_guard lock(mutex);
    transcript.connections[connection].push_back(line_of(is_question, std::move(frame)));
  }
};

struct Upstream {
  wire::Endpoint server;
  Deadlines deadlines;
  std::size_t largest = 0;
};

// A WebSocket's question has one answer, but vla-eval's words of episodes have none.
bool has_answer(Protocol protocol, const wire::Frame& asked) {
  if (protocol != Protocol::kVlaEval) return true;
  const auto message = vlaeval::from_bytes(asked.bytes);
  return !message || (message->type != "episode_start" && message->type != "episode_end");
}

class WebSocketBetween final : public wire::Speaker {
 public:
  WebSocketBetween(Protocol protocol, Upstream upstream, std::shared_ptr<Record> record)
      : protocol_(protocol),
        upstream_(std::move(upstream)),
        record_(std::move(record)),
        connection_(record_->begin()) {}

  std::vector<wire::Frame> greet() override {
    wire::WebSocketOptions options;
    options.connect_timeout = upstream_.deadlines.connect;
    options.largest_message = upstream_.largest;
    if (const std::string key = api_key(); !key.empty())
      options.headers.emplace_back("Authorization", "Api-Key " + key);
    auto socket = wire::WebSocket::connect(upstream_.server, options);
    if (!socket) return {};  // the first question is then told
    socket_ = std::move(*socket);
    if (protocol_ == Protocol::kVlaEval) return {};
    return received(upstream_.deadlines.connect).frames;
  }

  Reply answer(const wire::Frame& asked) override {
    record_->add(connection_, true, asked);
    if (!socket_) return {{}, "the server cannot be reached"};
    if (auto sent = socket_->send(asked.bytes, upstream_.deadlines.answer); !sent)
      return {{}, sent.failure().message};
    if (!has_answer(protocol_, asked)) return {};
    return received(upstream_.deadlines.answer);
  }

 private:
  Reply received(wire::Duration timeout) {
    auto message = socket_->receive(timeout);
    if (!message) return {{}, message.failure().message};
    wire::Frame frame{message->is_text, std::move(message->bytes)};
    record_->add(connection_, false, frame);
    return {{std::move(frame)}};
  }

  Protocol protocol_;
  Upstream upstream_;
  std::shared_ptr<Record> record_;
  std::size_t connection_;
  std::unique_ptr<wire::WebSocket> socket_;
};

// ZeroMQ, HTTP and gRPC: an answer to each question.
class Between final : public wire::Speaker {
 public:
  Between(Protocol protocol, Upstream upstream, std::shared_ptr<Record> record)
      : protocol_(protocol),
        upstream_(std::move(upstream)),
        record_(std::move(record)),
        connection_(record_->begin()) {}

  Reply answer(const wire::Frame& asked) override {
    record_->add(connection_, true, asked);
    auto bytes = carried(asked);
    if (!bytes) return {{}, bytes.failure().message};
    wire::Frame frame{false, std::move(*bytes)};
    record_->add(connection_, false, frame);
    return {{std::move(frame)}};
  }

 private:
  Result<wire::Bytes> carried(const wire::Frame& asked) {
    switch (row_of(protocol_).carrier) {
      case Carrier::kZmq:
        return by_zmq(asked);
      case Carrier::kGrpc:
        return by_grpc(asked);
      case Carrier::kHttp:
      case Carrier::kWebSocket:
        break;
    }
    return by_http(asked);
  }
  Result<wire::Bytes> by_grpc(const wire::Frame& asked) {
    if (!channel_) {
      wire::GrpcOptions options;
      options.connect_timeout = upstream_.deadlines.connect;
      options.largest_message = upstream_.largest;
      PROBE_ASSIGN(channel_, wire::GrpcChannel::connect(upstream_.server, options));
    }
    PROBE_ASSIGN(const wire::GrpcCall call, wire::call_of(asked));
    return channel_->call(call, upstream_.deadlines.answer);
  }
  Result<wire::Bytes> by_zmq(const wire::Frame& asked) {
    if (!socket_) {
      wire::ZmqOptions options;
      options.connect_timeout = upstream_.deadlines.connect;
      options.largest_message = upstream_.largest;
      PROBE_ASSIGN(socket_, wire::ZmqRequester::create(upstream_.server, options));
    }
    return socket_->ask(asked.bytes, upstream_.deadlines.answer);
  }
  Result<wire::Bytes> by_http(const wire::Frame& asked) {
    wire::HttpRequest post;
    post.method = "POST";
    post.path = path_of(row_of(protocol_), upstream_.server);
    post.body.assign(asked.bytes.begin(), asked.bytes.end());
    PROBE_ASSIGN(const wire::HttpResponse answer,
                 wire::http_exchange(
                     upstream_.server, post,
                     {upstream_.deadlines.connect, upstream_.deadlines.answer, upstream_.largest}));
    return wire::Bytes(answer.body.begin(), answer.body.end());
  }

  Protocol protocol_;
  Upstream upstream_;
  std::shared_ptr<Record> record_;
  std::size_t connection_;
  std::unique_ptr<wire::ZmqRequester> socket_;
  std::unique_ptr<wire::GrpcChannel> channel_;
};

}  // namespace

Result<Transcript> record(const ServerChoice& choice) {
  const Profile& profile = choice.profile;
  const auto kept = std::make_shared<Record>();
  kept->transcript.protocol = profile.protocol;
  const Upstream upstream{choice.server,
                          {to_duration(profile.connect_s), to_duration(profile.first_s)},
                          static_cast<std::size_t>(profile.largest_answer) << 20};
  const Protocol protocol = profile.protocol;
  const auto between = [protocol, upstream, kept]() -> std::unique_ptr<wire::Speaker> {
    if (row_of(protocol).carrier != Carrier::kWebSocket)
      return std::make_unique<Between>(protocol, upstream, kept);
    return std::make_unique<WebSocketBetween>(protocol, upstream, kept);
  };
  auto listener = listen_over(row_of(protocol).carrier)("127.0.0.1", "0", between);
  if (!listener) return listener.failure();
  ServerChoice here = choice;
  here.server.host = "127.0.0.1";
  here.server.port = (*listener)->port();
  here.server.tls = {};
  PROBE_TRY(test_server(here));
  listener->reset();  // no connection writes any more
  return std::move(kept->transcript);
}

}  // namespace probe::servers
