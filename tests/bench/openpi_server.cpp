// A thread a connection, each blocking.
#include "tests/bench/openpi_server.h"

#include <utility>  // which Boost 1.74's asio uses without including it

#include <atomic>
#include <boost/asio.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/websocket.hpp>
#include <list>
#include <mutex>
#include <thread>

#include "runtime/wire/msgpack.h"

namespace probe::bench {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
using Socket = beast::websocket::stream<asio::ip::tcp::socket>;

wire::Bytes still_actions() {
  std::vector<double> values;
  for (int i = 0; i < 4; ++i) values.insert(values.end(), {0, 0, 0, 0, 0, 0, 1});
  return wire::to_msgpack(wire::Map{{"actions", wire::array_f64({4, 7}, values)}},
                          wire::ArrayStyle::kBinKeys);
}

}  // namespace

class OpenpiServer::Listener {
 public:
  explicit Listener(std::chrono::milliseconds answer_time)
      : answer_time_(answer_time),
        acceptor_(context_, {asio::ip::address_v4::loopback(), 0}),
        accepting_([this] { accept(); }) {}
  ~Listener() {
    // A connection wakes the accept; the sockets' ends wake the readers.
    stopping_ = true;
    asio::ip::tcp::socket wake(context_);
    boost::system::error_code ignored;
    wake.connect(acceptor_.local_endpoint(), ignored);
    accepting_.join();
    for (Socket& socket : sockets_) {
      socket.next_layer().shutdown(asio::ip::tcp::socket::shutdown_both, ignored);
    }
    for (std::thread& thread : threads_) thread.join();
  }
  int port() const { return acceptor_.local_endpoint().port(); }

 private:
  void accept() {
    for (;;) {
      asio::ip::tcp::socket socket(context_);
      boost::system::error_code error;
      acceptor_.accept(socket, error);
      if (error || stopping_) return;
      socket.set_option(asio::ip::tcp::no_delay(true), error);
      Socket& kept = sockets_.emplace_back(std::move(socket));
      threads_.emplace_back([this, &kept] { serve(kept); });
    }
  }

  void serve(Socket& socket) {
    const wire::Bytes hello = {0x80}, answer = still_actions();
    beast::error_code error;
    socket.accept(error);
    socket.binary(true);
    socket.read_message_max(std::size_t{64} << 20);
    if (!error) socket.write(asio::buffer(hello), error);
    for (beast::flat_buffer message; !error; message.clear()) {
      socket.read(message, error);
      if (error) return;
      if (answer_time_.count() > 0) {
        const std::lock_guard one_at_a_time(gpu_);
        std::this_thread::sleep_for(answer_time_);
      }
      socket.write(asio::buffer(answer), error);
    }
  }

  std::chrono::milliseconds answer_time_;
  asio::io_context context_;
  asio::ip::tcp::acceptor acceptor_;
  std::mutex gpu_;
  std::list<Socket> sockets_;
  std::list<std::thread> threads_;
  std::atomic<bool> stopping_ = false;
  std::thread accepting_;  // last: it uses the others
};

OpenpiServer::OpenpiServer(std::chrono::milliseconds answer_time)
    : listener_(std::make_unique<Listener>(answer_time)) {}

OpenpiServer::~OpenpiServer() = default;

std::string OpenpiServer::policy() const {
  return "openpi://127.0.0.1:" + std::to_string(listener_->port());
}

}  // namespace probe::bench
