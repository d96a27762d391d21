// Connections taken one thread each and all ended together. Private to the listeners of WebSocket
// and HTTP; includes Boost.Asio.
#pragma once

#include <atomic>
#include <boost/asio.hpp>
#include <list>
#include <mutex>
#include <thread>

#include "runtime/wire/listener.h"
#include "runtime/wire/served_link.h"

namespace probe::wire::beast_io {

class TcpListener : public Listener {
 public:
  using Socket = boost::asio::ip::tcp::socket;

  TcpListener() : acceptor_(io_) {}
  TcpListener(const TcpListener&) = delete;
  TcpListener& operator=(const TcpListener&) = delete;

  Status listen(const std::string& address, const std::string& port, const TlsFiles& tls) {
    if (tls.is_on()) {
      PROBE_ASSIGN(identity_, TlsIdentity::read(tls));
    }
    boost::system::error_code error;
    const auto failed = [&](const char* doing) {
      return Failure{Fault::kUsage, std::string(doing) + ": " + error.message(),
                     address + ":" + port};
    };
    const auto ip = boost::asio::ip::make_address(address, error);
    if (error) return failed("the address");
    int number = 0;
    for (const char c : port) {
      if (c < '0' || c > '9' || number > 65535) number = 65536;
      number = number * 10 + (c - '0');
    }
    if (port.empty() || number > 65535)
      return Failure{Fault::kUsage, "`" + port + "` is no port from 0 to 65535", address};
    const boost::asio::ip::tcp::endpoint place(ip, static_cast<unsigned short>(number));
    acceptor_.open(place.protocol(), error);
    if (error) return failed("listening");
    acceptor_.set_option(boost::asio::socket_base::reuse_address(true), error);
    acceptor_.bind(place, error);
    if (error) return failed("listening");
    acceptor_.listen(boost::asio::socket_base::max_listen_connections, error);
    if (error) return failed("listening");
    port_ = std::to_string(acceptor_.local_endpoint(error).port());
    thread_ = std::thread([this] { accept(); });
    return {};
  }

  std::string port() const override { return port_; }

 protected:
  // A connection from its first byte to its last; whatever it throws ends it alone.
  virtual void serve(ServedLink& link) = 0;

  // By the destructors of derived classes, whose serve() uses what they have.
  void stop() {
    {
      const std::lock_guard lock(mutex_);
      is_over_ = true;
      ::shutdown(acceptor_.native_handle(), SHUT_RDWR);  // wakes accept()
      for (Connection& connection : connections_) {
        boost::system::error_code ignored;
        connection.socket.shutdown(Socket::shutdown_both, ignored);
      }
    }
    if (thread_.joinable()) thread_.join();
    for (Connection& connection : connections_) connection.thread.join();
    connections_.clear();
  }

 private:
  struct Connection {
    explicit Connection(Socket taken) : socket(std::move(taken)) {}
    Socket socket;
    std::thread thread;
    std::atomic<bool> is_over = false;
  };

  void accept() {
    while (true) {
      boost::system::error_code error;
      Socket socket(io_);
      acceptor_.accept(socket, error);
      const std::lock_guard lock(mutex_);
      if (is_over_ || (error && error != boost::asio::error::connection_aborted)) return;
      if (error) continue;
      socket.set_option(boost::asio::ip::tcp::no_delay(true), error);
      Connection& connection = connections_.emplace_back(std::move(socket));
      connection.thread = std::thread([this, &connection] {
        try {
          boost::system::error_code refused;
          ServedLink link(connection.socket, identity_);
          link.open(refused);
          if (!refused) serve(link);
        } catch (const std::exception&) {
        }
        boost::system::error_code ignored;
        connection.socket.shutdown(Socket::shutdown_both, ignored);
        connection.is_over = true;
      });
      // A thread that nobody waits for keeps its stack.
      connections_.remove_if([](Connection& old) {
        if (!old.is_over) return false;
        old.thread.join();
        return true;
      });
    }
  }

  boost::asio::io_context io_;
  boost::asio::ip::tcp::acceptor acceptor_;
  std::string port_;
  std::shared_ptr<TlsIdentity> identity_;  // none: plain
  std::thread thread_;
  std::mutex mutex_;  // the two below
  std::list<Connection> connections_;
  bool is_over_ = false;
};

}  // namespace probe::wire::beast_io
