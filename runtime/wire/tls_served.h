// TLS from the server's side. Private to served_link.h.
#pragma once

#include <boost/asio/buffer.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <memory>

#include "runtime/base/result.h"
#include "runtime/wire/listener.h"

namespace probe::wire::beast_io {

// What a server shows its clients; all of its connections have one.
class TlsIdentity {
 public:
  // Fails (kUsage, where = the file) on a file that cannot be read, that is no PEM of its kind, and
  // on a key that is not the certificate's.
  static Result<std::shared_ptr<TlsIdentity>> read(const TlsFiles& files);
  ~TlsIdentity();

 private:
  friend class ServedTlsStream;
  struct Parts;
  explicit TlsIdentity(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

// One connection. Every call waits; one thread at a time.
class ServedTlsStream {
 public:
  using Error = boost::system::error_code;

  ServedTlsStream(boost::asio::ip::tcp::socket& socket, std::shared_ptr<TlsIdentity> identity);
  ~ServedTlsStream();
  void handshake(Error& error);
  std::size_t read_some(boost::asio::mutable_buffer buffer, Error& error);
  std::size_t write_some(boost::asio::const_buffer buffer, Error& error);
  // Says that nothing more comes and waits for the client to say so, too.
  void shutdown(Error& error);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace probe::wire::beast_io
