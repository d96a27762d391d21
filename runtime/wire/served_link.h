// A taken connection, plain or over TLS, as one type for the listeners of WebSocket and HTTP: a
// SyncStream of Beast's. Private to these.
#pragma once

#include <array>
#include <boost/asio/buffer.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/websocket/teardown.hpp>
#include <memory>
#include <optional>

#include "runtime/wire/tls_served.h"

namespace probe::wire::beast_io {

class ServedLink {
 public:
  using Socket = boost::asio::ip::tcp::socket;
  using Error = boost::system::error_code;
  using executor_type = Socket::executor_type;

  // `identity` may be null: then it is plain.
  ServedLink(Socket& socket, std::shared_ptr<TlsIdentity> identity) : socket_(socket) {
    if (identity) tls_.emplace(socket, std::move(identity));
  }
  executor_type get_executor() noexcept { return socket_.get_executor(); }
  Socket& next_layer() { return socket_; }

  // Agrees on TLS where there is one, before anything else.
  void open(Error& error) {
    if (tls_) tls_->handshake(error);
  }
  // Ends TLS as clients expect it, after everything else.
  void end() {
    Error ignored;
    if (tls_) tls_->shutdown(ignored);
  }

  template <typename Buffers>
  std::size_t read_some(const Buffers& buffers, Error& error) {
    return tls_ ? tls_->read_some(first_of(buffers), error) : socket_.read_some(buffers, error);
  }
  template <typename Buffers>
  std::size_t write_some(const Buffers& buffers, Error& error) {
    if (!tls_) return socket_.write_some(buffers, error);
    // A frame's head and what follows it in one record.
    const std::size_t size = boost::asio::buffer_copy(boost::asio::buffer(record_), buffers);
    return tls_->write_some(boost::asio::buffer(record_.data(), size), error);
  }
  template <typename Buffers>
  std::size_t read_some(const Buffers& buffers) {
    Error error;
    const std::size_t size = read_some(buffers, error);
    if (error) throw boost::system::system_error(error);
    return size;
  }
  template <typename Buffers>
  std::size_t write_some(const Buffers& buffers) {
    Error error;
    const std::size_t size = write_some(buffers, error);
    if (error) throw boost::system::system_error(error);
    return size;
  }

  friend void teardown(boost::beast::role_type role, ServedLink& link, Error& error) {
    link.end();
    boost::beast::websocket::teardown(role, link.socket_, error);
  }

 private:
  template <typename Buffers>
  static boost::asio::mutable_buffer first_of(const Buffers& buffers) {
    const auto end = boost::asio::buffer_sequence_end(buffers);
    for (auto at = boost::asio::buffer_sequence_begin(buffers); at != end; ++at) {
      const boost::asio::mutable_buffer buffer(*at);
      if (buffer.size() > 0) return buffer;
    }
    return {};
  }

  Socket& socket_;
  std::optional<ServedTlsStream> tls_;
  std::array<char, 16384> record_;  // the most that a record of TLS holds
};

}  // namespace probe::wire::beast_io
