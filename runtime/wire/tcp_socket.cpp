#include "runtime/wire/tcp_socket.h"

#include "runtime/wire/beast_io.h"

namespace probe::wire {

Result<int> connect_socket(const Endpoint& server, Duration timeout, const Resolver& resolver) {
  try {
    boost::asio::io_context io;
    boost::beast::tcp_stream stream(io);
    PROBE_TRY(beast_io::connect_tcp(io, stream, server, beast_io::Deadline::in(timeout), resolver));
    auto socket = stream.release_socket();
    socket.native_non_blocking(true);
    return socket.release();
  } catch (const std::exception& error) {
    return Failure{Fault::kPolicy, error.what(), server.name()};
  }
}

}  // namespace probe::wire
