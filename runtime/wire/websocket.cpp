#include "runtime/wire/websocket.h"

#include <boost/beast/websocket.hpp>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <optional>
#include <thread>

#include "runtime/base/printable.h"
#include "runtime/wire/http.h"
#include "runtime/wire/link.h"

namespace probe::wire {
namespace {

namespace beast = boost::beast;
namespace asio = boost::asio;
namespace websocket = beast::websocket;
using beast_io::error_code;

// For a server to answer a close; one that has not answered a question will not answer this.
constexpr Duration kCloseTimeout{200};
constexpr Duration kLateCloseTimeout{20};
// Messages that nobody has asked for yet; a server that floods must not fill the memory.
constexpr std::size_t kLargestInbox = 16;

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
      changed_.wait_for(lock, is_late_ ? kLateCloseTimeout : kCloseTimeout,
                        [this] { return broken_.has_value(); });
    }
    io_.stop();
    thread_.join();
  }

  Status open(const Endpoint& server) {
    const auto deadline = beast_io::Deadline::in(options_.connect_timeout);
    auto& stream = beast::get_lowest_layer(socket_);
    PROBE_TRY(socket_.next_layer().open(io_, server, deadline, options_.resolver));
    socket_.set_option(websocket::stream_base::timeout{options_.connect_timeout,
                                                       websocket::stream_base::none(), false});
    socket_.set_option(websocket::stream_base::decorator([this](websocket::request_type& request) {
      for (const auto& [field, value] : options_.headers) request.set(field, value);
    }));
    socket_.read_message_max(options_.largest_message);
    socket_.auto_fragment(false);
    socket_.write_buffer_bytes(std::size_t{1} << 16);
    socket_.binary(true);
    unsigned status = 0;
    if (auto agreed = shake_hands(stream, server, deadline, &status); !agreed) {
      // Ports of TLS answer plain questions with nothing that is HTTP, or with 400.
      if (status != 0 && status != 400) return agreed;
      return unless_tls(agreed.failure(), server, deadline, options_.resolver, "wss://");
    }
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
                            is_write_fine_ = !error;
                            if (error) break_off("sending: " + error.message());
                            changed_.notify_all();
                          });
    });
    if (changed_.wait_for(lock, timeout, [this] { return sent_; })) {
      // What the reader may have met since is receive()'s to tell, after the messages before it.
      return is_write_fine_ ? Status() : Status(*broken_);
    }
    break_off("took no message for " + seconds_text(timeout));
    lock.unlock();
    asio::post(io_, [this] { beast::get_lowest_layer(socket_).cancel(); });
    lock.lock();
    changed_.wait(lock, [this] { return sent_; });
    return *broken_;
  }

  bool has_message() {
    std::lock_guard guard(mutex_);
    return !inbox_.empty();
  }

  bool awaits_message(Duration wait) {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, wait, [this] { return !inbox_.empty() || broken_; });
    return !inbox_.empty();
  }

  Result<Message> receive(Duration timeout) {
    std::unique_lock lock(mutex_);
    if (!changed_.wait_for(lock, timeout, [this] { return !inbox_.empty() || broken_; })) {
      is_late_ = true;
      return Failure{Fault::kPolicy, "no answer in " + seconds_text(timeout), name_};
    }
    if (inbox_.empty()) return *broken_;
    Message message = std::move(inbox_.front());
    inbox_.pop_front();
    return message;
  }

 private:
  // `status` becomes that of an HTTP answer that is no WebSocket.
  Status shake_hands(beast::tcp_stream& stream, const Endpoint& server,
                     const beast_io::Deadline& deadline, unsigned* status) {
    // Filled in while the handshake runs; given up, it must outlive what is under way.
    const auto response = std::make_shared<websocket::response_type>();
    bool is_declined = false;
    PROBE_TRY(beast_io::finish(
        io_, stream, deadline, name_, "opening a WebSocket", [&, response](auto done) {
          socket_.async_handshake(*response, server.authority(), server.path,
                                  [&is_declined, response, done](error_code error) {
                                    is_declined = error == websocket::error::upgrade_declined;
                                    done(is_declined ? error_code() : error);
                                  });
        }));
    if (!is_declined) return {};
    *status = response->result_int();
    const std::string location((*response)[beast::http::field::location]);
    const std::string elsewhere = sent_elsewhere(response->result_int(), location, true);
    const bool is_declined_for_good =
        !elsewhere.empty() || response->result() == beast::http::status::unauthorized ||
        response->result() == beast::http::status::forbidden;  // others may be a server that starts
    return Failure{is_declined_for_good ? Fault::kAnswered : Fault::kPolicy,
                   "opening a WebSocket: answered with HTTP status " +
                       std::to_string(response->result_int()) + elsewhere,
                   name_};
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
      if (inbox_.size() > kLargestInbox) {
        inbox_.clear();
        break_off("the server sends messages that nothing asked for");
      }
      changed_.notify_all();
      if (!broken_) read_next();
    });
  }

  std::string reason(const error_code& error) {
    // Also where our answer to its close met a connection that was gone by then.
    if (const auto& why = socket_.reason(); why.code != websocket::close_code::none) {
      const std::string text = printable(why.reason.c_str(), 123);  // as long as a reason may be
      return "the server closed the connection (code " + std::to_string(why.code) +
             (text.empty() ? ")" : ": " + text + ")");
    }
    if (error == websocket::error::message_too_big) {
      return "an answer of more than " + std::to_string(options_.largest_message >> 20) + " MiB";
    }
    if (error.category() == error_code(websocket::error::bad_opcode).category() &&
        error != websocket::error::closed) {
      return "what came is no WebSocket message (" + error.message() + ")";
    }
    if (const auto said = beast_io::said_by_tls(error)) return *said;
    if (beast_io::is_cut_off(error)) return "the server went away without ending TLS";
    if (error == asio::error::eof || error == asio::error::connection_reset ||
        error == asio::error::not_connected || error == asio::error::broken_pipe ||
        error == websocket::error::closed) {
      return "the server went away";
    }
    return error.message();
  }

  // Under mutex_. The first reason is the one that counts.
  void break_off(const std::string& why) {
    if (!broken_) broken_ = Failure{Fault::kPolicy, why, name_};
  }

  std::string name_;
  WebSocketOptions options_;
  asio::io_context io_;
  websocket::stream<beast_io::Link> socket_;
  beast::flat_buffer buffer_;
  std::thread thread_;

  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Message> inbox_;
  std::optional<Failure> broken_;
  bool sent_ = false;
  bool is_write_fine_ = false;
  bool is_late_ = false;  // an answer did not come in time
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
    return Failure{Fault::kPolicy, error.what(), server.name()};
  }
}

Status WebSocket::send(std::span<const std::uint8_t> bytes, Duration timeout) {
  return connection_->send(bytes, timeout);
}

Result<Message> WebSocket::receive(Duration timeout) { return connection_->receive(timeout); }

bool WebSocket::has_message() const { return connection_->has_message(); }
bool WebSocket::awaits_message(Duration wait) const { return connection_->awaits_message(wait); }

}  // namespace probe::wire
