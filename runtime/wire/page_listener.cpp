// Pages and conversations, by Boost.Beast. A conversation has a loop of its own in its thread, as
// only that lets it speak while it listens.
#include "runtime/wire/page_listener.h"

#include <unistd.h>

#include <atomic>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <deque>
#include <mutex>

#include "runtime/wire/tcp_listener.h"

namespace probe::wire {
namespace {

namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using boost::asio::ip::tcp;
using Error = boost::system::error_code;

constexpr std::uint32_t kLargestHead = 16 << 10;
constexpr std::uint64_t kLargestBody = 64 << 10;

class Conversation final : public Mouth, public std::enable_shared_from_this<Conversation> {
 public:
  Conversation(boost::asio::io_context& io, tcp::socket socket)
      : io_(&io), stream_(std::move(socket)) {}

  websocket::stream<tcp::socket>& stream() { return stream_; }

  void say(Frame frame) override {
    const std::lock_guard lock(mutex_);
    if (io_ == nullptr) return;
    unread_ += frame.bytes.size();
    boost::asio::post(*io_, [self = shared_from_this(), frame = std::move(frame)]() mutable {
      self->waiting_.push_back(std::move(frame));
      if (self->waiting_.size() == 1) self->write();
    });
  }

  std::size_t unread() const override { return unread_; }

  void end(const std::string& why) override {
    const std::lock_guard lock(mutex_);
    if (io_ == nullptr) return;
    boost::asio::post(*io_, [self = shared_from_this(), why = why.substr(0, 120)] {
      if (self->last_) return;  // it is being closed
      self->last_ = why;
      if (self->waiting_.empty()) self->close();
    });
  }

  // Until one side ends it.
  void listen(Ear& ear) {
    read(ear);
    io_->run();
  }

  // No thread finds the loop after this.
  void leave() {
    const std::lock_guard lock(mutex_);
    io_ = nullptr;
  }

 private:
  // What is left when the loop is gone ends with an error, and has no loop to stop.
  void stop() {
    if (io_ != nullptr) io_->stop();
  }

  void read(Ear& ear) {
    stream_.async_read(buffer_, [this, &ear](Error error, std::size_t) {
      if (error) return stop();
      const auto* data = static_cast<const std::uint8_t*>(buffer_.data().data());
      const Frame heard{stream_.got_text(), Bytes(data, data + buffer_.size())};
      buffer_.consume(buffer_.size());
      ear.hear(heard);
      Error ignored;
      if (stream_.next_layer().available(ignored) == 0) ear.rest();
      read(ear);
    });
  }

  void write() {
    stream_.text(waiting_.front().is_text);
    stream_.async_write(boost::asio::buffer(waiting_.front().bytes),
                        [this](Error error, std::size_t) {
                          if (error) return stop();
                          unread_ -= waiting_.front().bytes.size();
                          waiting_.pop_front();
                          if (!waiting_.empty()) return write();
                          if (last_) close();
                        });
  }

  void close() {
    // The read that waits ends with it.
    stream_.async_close({websocket::close_code::normal, *last_}, [](Error) {});
  }

  mutable std::mutex mutex_;  // of io_, for other threads
  boost::asio::io_context* io_;
  websocket::stream<tcp::socket> stream_;
  beast::flat_buffer buffer_;
  std::deque<Frame> waiting_;
  std::optional<std::string> last_;
  std::atomic<std::size_t> unread_ = 0;
};

class PageListener final : public beast_io::TcpListener {
 public:
  explicit PageListener(PageRules rules) : rules_(std::move(rules)) {}
  ~PageListener() override { stop(); }

 private:
  using Request = http::request<http::string_body>;

  void serve(beast_io::ServedLink& link) override {
    beast::flat_buffer buffer;
    http::request_parser<http::string_body> parser;
    parser.header_limit(kLargestHead);
    parser.body_limit(kLargestBody);
    http::read(link, buffer, parser);
    const Request& asked = parser.get();
    Visit visit;
    visit.method = std::string(asked.method_string());
    visit.target = std::string(asked.target());
    visit.host = std::string(asked[http::field::host]);
    visit.origin = std::string(asked[http::field::origin]);
    visit.site = std::string(asked["Sec-Fetch-Site"]);
    visit.is_upgrade = websocket::is_upgrade(asked);
    if (auto refused = rules_.refuse(visit)) return answer(link, asked, std::move(*refused));
    if (!visit.is_upgrade) return answer(link, asked, rules_.page(visit));
    talk(link, asked, visit);
  }

  void talk(beast_io::ServedLink& link, const Request& asked, const Visit& visit) {
    // The same connection with another loop; stop() still ends it by the socket that it knows.
    boost::asio::io_context io(1);
    const int copy = ::dup(link.next_layer().native_handle());
    if (copy < 0) return;
    tcp::socket own(io, link.next_layer().local_endpoint().protocol(), copy);
    const auto conversation = std::make_shared<Conversation>(io, std::move(own));
    auto& stream = conversation->stream();
    stream.read_message_max(rules_.largest_message);
    stream.auto_fragment(false);
    auto ear = rules_.talk(visit, conversation);
    if (ear == nullptr) return answer(link, asked, {404, "text/plain", "nobody talks here\n"});
    Error error;
    stream.accept(asked, error);
    try {
      if (!error) conversation->listen(*ear);
    } catch (const std::exception&) {
    }
    conversation->leave();
    ear.reset();
    // What was posted meanwhile holds the conversation, and goes before its loop does.
    io.restart();
    io.poll();
  }

  static void answer(beast_io::ServedLink& link, const Request& asked, Page page) {
    http::response<http::string_body> said(
        http::int_to_status(static_cast<unsigned>(page.status)), asked.version());
    said.set(http::field::content_type, page.type);
    for (const auto& [name, value] : page.headers) said.set(name, value);
    said.body() = std::move(page.body);
    said.keep_alive(false);
    said.prepare_payload();
    if (asked.method() == http::verb::head) said.body().clear();
    http::write(link, said);
    link.end();
  }

  const PageRules rules_;
};

}  // namespace

Result<std::unique_ptr<Listener>> listen_pages(const std::string& address, const std::string& port,
                                               PageRules rules) {
  auto listener = std::make_unique<PageListener>(std::move(rules));
  PROBE_TRY(listener->listen(address, port, {}));
  return std::unique_ptr<Listener>(std::move(listener));
}

}  // namespace probe::wire
