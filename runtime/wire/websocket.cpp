#include "runtime/wire/websocket.h"

#include <boost/asio.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/websocket.hpp>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <optional>
#include <thread>

namespace probe::wire {
namespace {

namespace beast = boost::beast;
namespace asio = boost::asio;
namespace websocket = beast::websocket;
using boost::system::error_code;
using tcp = asio::ip::tcp;

constexpr Duration kCloseTimeout{500};

}  // namespace

// Everything of Beast runs on `thread_` once it is started; the caller's thread and it share what
// `mutex_` guards.
class WebSocket::Connection {
 public:
  Connection(std::string name, const WebSocketOptions& options)
      : name_(std::move(name)), options_(options), socket_(io_) {}

  ~Connection() {
    if (!thread_.joinable()) return;
    asio::post(io_, [this] {
      if (!socket_.is_open()) return;
      socket_.async_close(websocket::close_code::normal, [](error_code) {});
    });
    {
      std::unique_lock lock(mutex_);
      changed_.wait_for(lock, kCloseTimeout, [this] { return broken_.has_value(); });
    }
    io_.stop();
    thread_.join();
  }

  Status open(const Endpoint& server) {
    const auto deadline = std::chrono::steady_clock::now() + options_.connect_timeout;
    tcp::resolver resolver(io_);
    tcp::resolver::results_type addresses;
    PROBE_TRY(finish(deadline, "looking up the host", [&](auto done) {
      resolver.async_resolve(server.host, server.port, [&, done](error_code error, auto found) {
        addresses = std::move(found);
        done(error);
      });
    }));
    auto& stream = beast::get_lowest_layer(socket_);
    PROBE_TRY(finish(deadline, "connecting", [&](auto done) {
      stream.async_connect(addresses,
                           [done](error_code error, const tcp::endpoint&) { done(error); });
    }));
    error_code ignored;
    stream.socket().set_option(tcp::no_delay(true), ignored);
    stream.expires_never();
    socket_.set_option(websocket::stream_base::timeout{options_.connect_timeout,
                                                       websocket::stream_base::none(), false});
    socket_.set_option(websocket::stream_base::decorator([this](websocket::request_type& request) {
      for (const auto& [field, value] : options_.headers) request.set(field, value);
    }));
    socket_.read_message_max(options_.largest_message);
    socket_.auto_fragment(false);
    socket_.write_buffer_bytes(std::size_t{1} << 16);
    socket_.binary(true);
    PROBE_TRY(finish(deadline, "opening a WebSocket", [&](auto done) {
      socket_.async_handshake(name_, server.path, [done](error_code error) { done(error); });
    }));
    io_.restart();
    read_next();
    thread_ = std::thread([this] { io_.run(); });
    return {};
  }

  Status send(std::span<const std::uint8_t> bytes, Duration timeout) {
    std::unique_lock lock(mutex_);
    if (broken_) return *broken_;
    sent_ = false;
    // `bytes` stays valid: this call returns only when the write has ended, or has broken the
    // connection.
    asio::post(io_, [this, bytes] {
      socket_.async_write(asio::buffer(bytes.data(), bytes.size()),
                          [this](error_code error, std::size_t) {
                            std::lock_guard guard(mutex_);
                            sent_ = true;
                            if (error) break_off("sending: " + error.message());
                            changed_.notify_all();
                          });
    });
    if (changed_.wait_for(lock, timeout, [this] { return sent_; })) {
      return broken_ ? Status(*broken_) : Status();
    }
    break_off("took no message for " + seconds(timeout));
    lock.unlock();
    asio::post(io_, [this] { beast::get_lowest_layer(socket_).cancel(); });
    lock.lock();
    changed_.wait(lock, [this] { return sent_; });
    return *broken_;
  }

  Result<Message> receive(Duration timeout) {
    std::unique_lock lock(mutex_);
    if (!changed_.wait_for(lock, timeout, [this] { return !inbox_.empty() || broken_; })) {
      return Failure{"policy", "no answer in " + seconds(timeout), name_};
    }
    if (inbox_.empty()) return *broken_;
    Message message = std::move(inbox_.front());
    inbox_.pop_front();
    return message;
  }

 private:
  static std::string seconds(Duration time) {
    std::string text = std::to_string(static_cast<double>(time.count()) / 1000);
    text.erase(text.find_last_not_of('0') + 1);
    if (text.ends_with('.')) text.pop_back();
    return text + " s";
  }

  // Starts an operation and runs it here until it ends or `deadline` passes.
  template <typename Start>
  Status finish(std::chrono::steady_clock::time_point deadline, const std::string& doing,
                Start start) {
    std::optional<error_code> result;
    start([&result](error_code error) { result = error; });
    io_.restart();
    io_.run_until(deadline);
    if (!result) {
      // What is under way refers to this frame: it must end before this returns.
      error_code ignored;
      beast::get_lowest_layer(socket_).socket().close(ignored);
      io_.stop();
      return Failure{"policy", doing + " took more than " + seconds(options_.connect_timeout),
                     name_};
    }
    if (*result) return Failure{"policy", doing + ": " + result->message(), name_};
    return {};
  }

  void read_next() {
    socket_.async_read(buffer_, [this](error_code error, std::size_t) {
      std::lock_guard guard(mutex_);
      if (error) {
        break_off(reason(error));
        changed_.notify_all();
        return;
      }
      Message message;
      message.is_text = socket_.got_text();
      const auto data = buffer_.data();
      const auto* bytes = static_cast<const std::uint8_t*>(data.data());
      message.bytes.assign(bytes, bytes + data.size());
      buffer_.consume(buffer_.size());
      inbox_.push_back(std::move(message));
      changed_.notify_all();
      read_next();
    });
  }

  std::string reason(const error_code& error) {
    if (error == websocket::error::closed) {
      const auto& why = socket_.reason();
      const std::string text(why.reason.c_str());
      return "the server closed the connection (code " + std::to_string(why.code) +
             (text.empty() ? ")" : ": " + text + ")");
    }
    if (error == websocket::error::message_too_big) {
      return "an answer of more than " + std::to_string(options_.largest_message >> 20) + " MiB";
    }
    if (error == asio::error::eof || error == asio::error::connection_reset) {
      return "the server went away";
    }
    return error.message();
  }

  // Under mutex_. The first reason is the one that counts.
  void break_off(const std::string& why) {
    if (!broken_) broken_ = Failure{"policy", why, name_};
  }

  std::string name_;
  WebSocketOptions options_;
  asio::io_context io_;
  websocket::stream<beast::tcp_stream> socket_;
  beast::flat_buffer buffer_;
  std::thread thread_;

  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Message> inbox_;
  std::optional<Failure> broken_;
  bool sent_ = false;
};

WebSocket::WebSocket(std::unique_ptr<Connection> connection) : connection_(std::move(connection)) {}
WebSocket::~WebSocket() = default;

Result<std::unique_ptr<WebSocket>> WebSocket::connect(const Endpoint& server,
                                                      const WebSocketOptions& options) {
  try {
    auto connection = std::make_unique<Connection>(server.name(), options);
    PROBE_TRY(connection->open(server));
    return std::unique_ptr<WebSocket>(new WebSocket(std::move(connection)));
  } catch (const std::exception& error) {
    return Failure{"policy", error.what(), server.name()};
  }
}

Status WebSocket::send(std::span<const std::uint8_t> bytes, Duration timeout) {
  return connection_->send(bytes, timeout);
}

Result<Message> WebSocket::receive(Duration timeout) { return connection_->receive(timeout); }

}  // namespace probe::wire
