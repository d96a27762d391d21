// TLS over a TCP connection, by OpenSSL: certificates and host names are checked. Private to
// link.*; tls.cpp and tls_served.cpp alone include OpenSSL and Boost.Asio's part of it.
#pragma once

#include <boost/asio/buffer.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "runtime/base/result.h"
#include "runtime/wire/endpoint.h"

namespace probe::wire::beast_io {

class TlsStream {
 public:
  using Error = boost::system::error_code;
  using Done = std::function<void(Error)>;
  using DoneBytes = std::function<void(Error, std::size_t)>;

  // Fails (kUsage) where the file of authorities cannot be read.
  static Result<std::unique_ptr<TlsStream>> over(boost::asio::ip::tcp::socket& socket,
                                                 const Endpoint& server);
  ~TlsStream();

  // As Asio's own: each calls back later, once; one that reads and one that writes at a time.
  void async_handshake(Done done);
  void async_read_some(boost::asio::mutable_buffer buffer, DoneBytes done);
  void async_write_some(boost::asio::const_buffer buffer, DoneBytes done);
  void async_shutdown(Done done);

  // Why the handshake ended with `error`, and what can be done. kAnswered where the server is there
  // and another attempt would end the same.
  Failure refusal(const Error& error) const;

 private:
  struct Parts;
  explicit TlsStream(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

// What an error says of TLS itself, once the connection stands too: a server of TLS 1.3 refuses a
// client without a certificate only then. Nothing for other errors.
std::optional<std::string> said_by_tls(const boost::system::error_code& error);

// Whether a connection ended without TLS's own end (close_notify), as when it is cut.
bool is_cut_off(const boost::system::error_code& error);

// Of a connection that was cut before a byte came over it: with TLS 1.3 a client without a
// certificate that is wanted hears of it only so.
inline constexpr const char* kCutAtOnce =
    "the server closed the connection right behind TLS's handshake: does it want a certificate of "
    "its clients (mutual TLS)? vlaprobe has none";

}  // namespace probe::wire::beast_io
