#include "runtime/wire/zmq.h"

#include <linux/tcp.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <optional>
#include <string>
#include <zmq.hpp>

namespace probe::wire {
namespace {

using Clock = std::chrono::steady_clock;

// How often what comes in is held against its limit while an answer is waited for.
constexpr Duration kLook{20};
constexpr Duration kSilence{100};  // ms in which a socket that connects has told so

Duration left_until(Clock::time_point deadline) {
  const auto left = std::chrono::ceil<Duration>(deadline - Clock::now());
  return std::max(left, Duration::zero());
}

}  // namespace

// The bytes that came over a TCP connection so far; nothing where it is gone.
std::optional<std::uint64_t> bytes_received(int connection) {
  tcp_info info{};
  socklen_t size = sizeof info;
  // Older systems fill in less.
  constexpr std::size_t kNeeded = offsetof(tcp_info, tcpi_bytes_received) + sizeof(std::uint64_t);
  if (::getsockopt(connection, IPPROTO_TCP, TCP_INFO, &info, &size) != 0 || size < kNeeded)
    return std::nullopt;
  return info.tcpi_bytes_received;
}

// A REQ socket and the socket that tells what happens to its connection. Without the latter a
// server that is gone would look like one that is slow.
class ZmqRequester::Sockets {
 public:
  Sockets(const Endpoint& server, const ZmqOptions& options)
      : server_(server), options_(options), context_(1) {}

  Result<Bytes> ask(std::span<const std::uint8_t> message, Duration timeout) {
    if (!request_) PROBE_TRY(open());
    Result<Bytes> answer = exchange(message, timeout);
    if (!answer) close();
    return answer;
  }

  std::string server() const { return server_.name(); }

  void close() {
    monitor_.reset();
    request_.reset();
  }

 private:
  Status open() {
    // Here and not by ZeroMQ, whose own look-up knows no deadline and is waited for at the end.
    PROBE_ASSIGN(const auto addresses, look_up(server_, options_.connect_timeout,
                                               options_.connect_timeout, options_.resolver));
    const auto is_v4 = [](const Address& address) {
      return address.ip.find(':') == address.ip.npos;
    };
    const auto v4 = std::find_if(addresses.begin(), addresses.end(), is_v4);
    const Address& address = v4 == addresses.end() ? addresses.front() : *v4;
    const bool is_ipv6 = !is_v4(address);
    reached_ = Reached::kNothing;
    lost_ = has_answered_ = has_begun_ = false;
    request_.emplace(context_, zmq::socket_type::req);
    request_->set(zmq::sockopt::linger, 0);
    // Messages wait for a connection here, where it is noticed, and not in a queue.
    request_->set(zmq::sockopt::immediate, true);
    request_->set(zmq::sockopt::maxmsgsize, static_cast<std::int64_t>(options_.largest_message));
    request_->set(zmq::sockopt::handshake_ivl, static_cast<int>(options_.connect_timeout.count()));
    request_->set(zmq::sockopt::ipv6, is_ipv6);
    // A closed socket keeps its name for a moment: each has another one.
    const std::string monitor = "inproc://monitor" + std::to_string(++opened_);
    if (zmq_socket_monitor(request_->handle(), monitor.c_str(), ZMQ_EVENT_ALL) != 0) {
      throw zmq::error_t();
    }
    monitor_.emplace(context_, zmq::socket_type::pair);
    monitor_->set(zmq::sockopt::linger, 0);
    monitor_->connect(monitor);
    const std::string host = is_ipv6 ? "[" + address.ip + "]" : address.ip;
    request_->connect("tcp://" + host + ":" + std::to_string(address.port));
    return {};
  }

  Result<Bytes> exchange(std::span<const std::uint8_t> message, Duration timeout) {
    // ZeroMQ connects again by itself: who asks is to know, as another may answer there now.
    while (has_news()) note_event();
    if (lost_ && has_answered_) return failed("the server went away after its last answer");
    PROBE_ASSIGN(const bool connects, connect(Clock::now() + options_.connect_timeout));
    if (!connects) return failed(unconnected());
    // What happened to earlier connections is no news of this one.
    while (has_news()) note_event();
    lost_ = is_flooded_ = false;
    received_ = bytes_received(connection_).value_or(0);
    if (!request_->send(zmq::buffer(message.data(), message.size()), zmq::send_flags::dontwait)) {
      return failed(unconnected());
    }
    if (!wait(ZMQ_POLLIN, Clock::now() + timeout)) {
      if (is_flooded_) {
        return failed("an answer of more than " + std::to_string(options_.largest_message >> 20) +
                      " MiB");
      }
      if (!lost_) return failed("no answer in " + seconds_text(timeout));
      // Any bytes at all can pass for a first version's greeting.
      return failed(
          std::string("the server closed the connection before it answered: it went away") +
          (has_answered_ ? "" : ", does not speak ZeroMQ") + ", or its answer has more than " +
          std::to_string(options_.largest_message >> 20) + " MiB");
    }
    zmq::message_t answer;
    if (!request_->recv(answer, zmq::recv_flags::dontwait)) return failed("no answer");
    if (answer.more()) return failed("an answer in several parts, where one was expected");
    has_answered_ = true;
    const auto* data = answer.data<std::uint8_t>();
    return Bytes(data, data + answer.size());
  }

  // ZeroMQ tells at once that it begins to connect. Now and then (4.3.4) a new socket begins
  // nothing and tells nothing: then another is made.
  Result<bool> connect(Clock::time_point deadline) {
    while (true) {
      if (wait(ZMQ_POLLOUT, std::min(deadline, Clock::now() + kSilence))) return true;
      if (lost_) return false;
      if (has_begun_) return wait(ZMQ_POLLOUT, deadline);
      if (Clock::now() >= deadline) return false;
      close();
      PROBE_TRY(open());
    }
  }

  // Until the socket is ready for `events`; false when it cannot be any more, or at the deadline.
  bool wait(short events, Clock::time_point deadline) {
    while (true) {
      zmq::pollitem_t items[] = {{request_->handle(), 0, events, 0},
                                 {monitor_->handle(), 0, ZMQ_POLLIN, 0}};
      const Duration left = left_until(deadline);
      zmq::poll(items, 2, std::min(left, kLook));
      if ((items[0].revents & events) != 0) return true;
      if ((items[1].revents & ZMQ_POLLIN) != 0) {
        note_event();
        if (lost_) return false;
        continue;
      }
      if (events == ZMQ_POLLIN && is_flood()) return false;
      if (left == Duration::zero()) return false;
    }
  }

  // ZeroMQ limits each part of a message and keeps any number of them until the last one is there.
  bool is_flood() {
    constexpr std::size_t kFrames = 1 << 16;  // bytes for greetings and heads
    const auto now = bytes_received(connection_);
    is_flooded_ = now && *now > received_ + options_.largest_message + kFrames;
    return is_flooded_;
  }

  bool has_news() {
    zmq::pollitem_t items[] = {{monitor_->handle(), 0, ZMQ_POLLIN, 0}};
    return zmq::poll(items, 1, Duration::zero()) > 0;
  }

  // How far the connection has ever come.
  enum class Reached { kNothing, kTcp, kZeroMq };

  void note_event() {
    zmq::message_t event, address;
    if (!monitor_->recv(event) || !monitor_->recv(address)) return;
    has_begun_ = true;
    std::uint16_t kind = 0;
    if (event.size() < sizeof kind) return;
    std::memcpy(&kind, event.data(), sizeof kind);
    std::int32_t value = -1;
    if (event.size() >= sizeof kind + sizeof value)
      std::memcpy(&value, event.data<char>() + sizeof kind, sizeof value);
    switch (kind) {
      case ZMQ_EVENT_CONNECTED:
        connection_ = value;
        if (reached_ == Reached::kNothing) reached_ = Reached::kTcp;
        break;
      case ZMQ_EVENT_HANDSHAKE_SUCCEEDED:
        reached_ = Reached::kZeroMq;
        break;
      // Each is the end of one attempt; ZeroMQ would go on for ever, callers have their own pauses.
      case ZMQ_EVENT_CLOSED:
      case ZMQ_EVENT_CONNECT_RETRIED:
      case ZMQ_EVENT_DISCONNECTED:
      case ZMQ_EVENT_HANDSHAKE_FAILED_NO_DETAIL:
      case ZMQ_EVENT_HANDSHAKE_FAILED_PROTOCOL:
      case ZMQ_EVENT_HANDSHAKE_FAILED_AUTH:
        lost_ = true;
        break;
      default:
        break;
    }
  }

  std::string unconnected() const {
    if (reached_ == Reached::kNothing) {
      return lost_ ? "connecting: nobody listens there"
                   : "connecting took more than " + seconds_text(options_.connect_timeout);
    }
    if (reached_ == Reached::kTcp) return "something listens there that does not speak ZeroMQ";
    return "the server went away";
  }

  Failure failed(const std::string& message) const {
    return {Fault::kPolicy, message, server_.name()};
  }

  Endpoint server_;
  ZmqOptions options_;
  zmq::context_t context_;
  std::optional<zmq::socket_t> request_, monitor_;
  int opened_ = 0;
  int connection_ = -1;         // ZeroMQ's, to be asked only how much came over it
  std::uint64_t received_ = 0;  // bytes before the last send
  bool is_flooded_ = false;     // more came since than an answer may have
  Reached reached_ = Reached::kNothing;
  bool has_answered_ = false;
  bool lost_ = false;       // the connection ended since the last send
  bool has_begun_ = false;  // something was told of the socket
};

ZmqRequester::ZmqRequester(std::unique_ptr<Sockets> sockets) : sockets_(std::move(sockets)) {}
ZmqRequester::~ZmqRequester() = default;

Result<std::unique_ptr<ZmqRequester>> ZmqRequester::create(const Endpoint& server,
                                                           const ZmqOptions& options) {
  try {
    return std::unique_ptr<ZmqRequester>(
        new ZmqRequester(std::make_unique<Sockets>(server, options)));
  } catch (const std::exception& error) {
    return Failure{Fault::kPolicy, error.what(), server.name()};
  }
}

Result<Bytes> ZmqRequester::ask(std::span<const std::uint8_t> message, Duration timeout) {
  try {
    return sockets_->ask(message, timeout);
  } catch (const std::exception& error) {
    sockets_->close();
    return Failure{Fault::kPolicy, error.what(), sockets_->server()};
  }
}

}  // namespace probe::wire
