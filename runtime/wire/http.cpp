#include "runtime/wire/http.h"

#include <boost/beast/http.hpp>

#include "runtime/wire/link.h"

namespace probe::wire {
namespace {

namespace beast = boost::beast;
namespace asio = boost::asio;
namespace http = beast::http;
using beast_io::error_code;

// Of what is not yet understood: a header, a chunk's own line, the fields behind the last chunk.
constexpr std::size_t kLargestBuffer = 256 << 10;

// Of a response's header, which no server of ours comes near.
constexpr std::uint32_t kLargestHeader = 64 << 10;

http::request<http::string_body> made(const Endpoint& server, const HttpRequest& request) {
  http::request<http::string_body> message(http::string_to_verb(request.method), request.path, 11);
  message.set(http::field::host, server.authority());
  message.set(http::field::user_agent, "vlaprobe");
  message.set(http::field::connection, "close");
  for (const auto& [field, value] : request.headers) message.set(field, value);
  if (!request.body.empty()) message.set(http::field::content_type, request.content_type);
  message.body() = request.body;
  message.prepare_payload();
  return message;
}

std::string reason(const error_code& error, const HttpOptions& options) {
  if (error == http::error::body_limit) {
    return "an answer of more than " + std::to_string(options.largest_body >> 20) + " MiB";
  }
  if (error == http::error::buffer_overflow) {
    return "the answer is no HTTP (a line of more than " + std::to_string(kLargestBuffer >> 10) +
           " KiB)";
  }
  if (error == http::error::partial_message || beast_io::is_cut_off(error)) {
    return "the server closed the connection in the middle of its answer";
  }
  if (error == http::error::end_of_stream || error == asio::error::connection_reset ||
      error == asio::error::broken_pipe || error == asio::error::eof) {
    return "the server closed the connection without an answer";
  }
  if (error.category() == error_code(http::error::bad_version).category()) {
    return "the answer is no HTTP (" + error.message() + ")";
  }
  return error.message();
}

Result<HttpResponse> exchange(const Endpoint& server, const HttpRequest& request,
                              const HttpOptions& options) {
  // The stream refers to the context and must go first.
  asio::io_context io;
  beast_io::Link link(io);
  auto& stream = link.next_layer();
  PROBE_TRY(
      link.open(io, server, beast_io::Deadline::in(options.connect_timeout), options.resolver));
  const auto deadline = beast_io::Deadline::in(options.timeout);
  const auto message = made(server, request);
  const auto written = beast_io::run_until(io, stream, deadline.at, [&](auto done) {
    http::async_write(link, message, [done](error_code error, std::size_t) { done(error); });
  });
  if (!written) {
    return Failure{Fault::kPolicy, "took no message for " + seconds_text(options.timeout),
                   server.name()};
  }
  // A server may answer "too large" and close while we still write: its answer counts.
  http::response_parser<http::string_body> parser;
  parser.body_limit(options.largest_body);
  parser.header_limit(kLargestHeader);
  beast::flat_buffer buffer(kLargestBuffer);
  const auto too_large = [&] {
    const auto length = parser.content_length();
    return length && *length > options.largest_body;
  };
  // In two steps, because Beast 1.74 forgets that a stated length is above the limit.
  auto read = beast_io::run_until(io, stream, deadline.at, [&](auto done) {
    http::async_read_header(link, buffer, parser,
                            [done](error_code error, std::size_t) { done(error); });
  });
  if (read && !*read && too_large()) read = error_code(http::error::body_limit);
  if (read && !*read) {
    read = beast_io::run_until(io, stream, deadline.at, [&](auto done) {
      http::async_read(link, buffer, parser,
                       [done](error_code error, std::size_t) { done(error); });
    });
  }
  if (!read) {
    return Failure{Fault::kPolicy, "no answer in " + seconds_text(options.timeout), server.name()};
  }
  if (*read) {
    const Failure failure{Fault::kPolicy, reason(*read, options), server.name()};
    if (parser.is_header_done()) return failure;
    return unless_tls(failure, server, deadline, options.resolver, "https://");
  }
  return HttpResponse{
      parser.get().result_int() > 999 ? 0 : static_cast<int>(parser.get().result_int()),
      std::move(parser.get().body())};
}

}  // namespace

Result<HttpResponse> http_exchange(const Endpoint& server, const HttpRequest& request,
                                   const HttpOptions& options) {
  try {
    return exchange(server, request, options);
  } catch (const std::exception& error) {
    return Failure{Fault::kPolicy, error.what(), server.name()};
  }
}

}  // namespace probe::wire
