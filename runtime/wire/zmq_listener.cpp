// ZeroMQ servers' side: a REP socket, which answers one question after the other.
#include <atomic>
#include <charconv>
#include <optional>
#include <thread>
#include <zmq.hpp>

#include "runtime/wire/listener.h"

namespace probe::wire {
namespace {

constexpr int kLookMs = 50;  // how often the thread sees whether it is over

// ZeroMQ takes what is beyond 65535 for another port.
bool is_listening_port(const std::string& text) {
  unsigned port = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), port);
  return error == std::errc() && end == text.data() + text.size() && port < 65536;
}

class ZmqListener final : public Listener {
 public:
  explicit ZmqListener(const MakeSpeaker& make)
      : speaker_(make()), context_(1), socket_(context_, zmq::socket_type::rep) {}
  ~ZmqListener() override {
    is_over_ = true;
    if (thread_.joinable()) thread_.join();
  }

  void listen(const std::string& address, const std::string& port) {
    socket_.set(zmq::sockopt::linger, 0);
    socket_.set(zmq::sockopt::rcvtimeo, kLookMs);
    socket_.set(zmq::sockopt::ipv6, address.find(':') != address.npos);
    const std::string host = address.find(':') == address.npos ? address : "[" + address + "]";
    socket_.bind("tcp://" + host + ":" + (port == "0" ? "*" : port));
    const std::string bound = socket_.get(zmq::sockopt::last_endpoint);
    port_ = bound.substr(bound.rfind(':') + 1);
    thread_ = std::thread([this] { run(); });
  }

  std::string port() const override { return port_; }

 private:
  void run() {
    try {
      while (!is_over_) {
        zmq::message_t message;
        if (!socket_.recv(message)) continue;
        const auto* data = static_cast<const std::uint8_t*>(message.data());
        const Speaker::Reply reply = speaker_->answer({false, Bytes(data, data + message.size())});
        // One part is one answer.
        Bytes bytes;
        for (const Frame& frame : reply.frames)
          bytes.insert(bytes.end(), frame.bytes.begin(), frame.bytes.end());
        socket_.send(zmq::buffer(bytes), zmq::send_flags::none);
      }
    } catch (const zmq::error_t&) {  // the server is over; clients see it gone
    }
  }

  std::unique_ptr<Speaker> speaker_;
  zmq::context_t context_;
  zmq::socket_t socket_;
  std::string port_;
  std::atomic<bool> is_over_ = false;
  std::thread thread_;
};

}  // namespace

Result<std::unique_ptr<Listener>> listen_zmq(const std::string& address, const std::string& port,
                                             MakeSpeaker make) {
  if (!is_listening_port(port))
    return Failure{Fault::kUsage, "`" + port + "` is no port from 0 to 65535", address};
  try {
    auto listener = std::make_unique<ZmqListener>(make);
    listener->listen(address, port);
    return std::unique_ptr<Listener>(std::move(listener));
  } catch (const zmq::error_t& error) {
    return Failure{Fault::kUsage, std::string("listening: ") + error.what(), address + ":" + port};
  }
}

}  // namespace probe::wire
