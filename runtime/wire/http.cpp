#include "runtime/wire/http.h"

#include <boost/beast/http.hpp>

#include "runtime/base/printable.h"
#include "runtime/wire/link.h"

namespace probe::wire {

namespace beast = boost::beast;
namespace asio = boost::asio;
namespace http = beast::http;

// A connection: what refers to the context goes before it.
struct HttpTalk {
  // Of what is not yet understood: a header, a chunk's own line, the fields behind the last chunk.
  static constexpr std::size_t kLargestBuffer = 256 << 10;
  asio::io_context io;
  beast_io::Link link{io};
  beast::flat_buffer buffer{kLargestBuffer};
};

namespace {
using beast_io::error_code;

// Of a response's header, which no server of ours comes near.
constexpr std::uint32_t kLargestHeader = 64 << 10;

http::request<http::string_body> made(const Endpoint& server, const HttpRequest& request,
                                      bool is_kept) {
  http::request<http::string_body> message(http::string_to_verb(request.method), request.path, 11);
  message.set(http::field::host, server.authority());
  message.set(http::field::user_agent, "vlaprobe");
  message.set(http::field::connection, is_kept ? "keep-alive" : "close");
  for (const auto& [field, value] : request.headers) message.set(field, value);
  if (!request.body.empty()) message.set(http::field::content_type, request.content_type);
  message.body() = request.body;
  message.prepare_payload();
  return message;
}

std::string reason(const error_code& error, const HttpOptions& options) {
  if (error == http::error::body_limit) {
    const std::size_t limit = options.largest_body;
    constexpr std::size_t kMib = std::size_t{1} << 20;
    return "an answer of more than " + (limit >= kMib ? std::to_string(limit >> 20) + " MiB"
                                                      : std::to_string(limit >> 10) + " KiB");
  }
  if (error == http::error::buffer_overflow) {
    return "the answer is no HTTP (a line of more than " +
           std::to_string(HttpTalk::kLargestBuffer >> 10) + " KiB)";
  }
  if (const auto said = beast_io::said_by_tls(error)) return *said;
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

struct Outcome {
  std::optional<HttpResponse> response;
  std::optional<Failure> failure;  // where there is no response
  bool is_kept = false;            // the connection may be used again
  bool is_stale = false;           // it was closed before the first byte of an answer
  bool is_headless = false;        // nothing that is HTTP came
};

// On an open connection, which is of no further use unless the outcome keeps it.
Outcome talk(HttpTalk& on, const Endpoint& server, const HttpRequest& request,
             const HttpOptions& options, bool wants_to_keep) {
  auto& stream = on.link.next_layer();
  const auto fail = [](Failure failure) {
    Outcome outcome;
    outcome.failure = std::move(failure);
    return outcome;
  };
  const auto deadline = beast_io::Deadline::in(options.timeout);
  const auto message = made(server, request, wants_to_keep);
  const auto written = beast_io::run_until(on.io, stream, deadline.at, [&](auto done) {
    http::async_write(on.link, message, [done](error_code error, std::size_t) { done(error); });
  });
  if (!written) {
    return fail(
        {Fault::kPolicy, "took no message for " + seconds_text(options.timeout), server.name()});
  }
  // A server may answer "too large" and close while we still write: its answer counts.
  http::response_parser<http::string_body> parser;
  parser.body_limit(options.largest_body);
  parser.header_limit(kLargestHeader);
  const auto too_large = [&] {
    const auto length = parser.content_length();
    return length && *length > options.largest_body;
  };
  // In two steps, because Beast 1.74 forgets that a stated length is above the limit.
  auto read = beast_io::run_until(on.io, stream, deadline.at, [&](auto done) {
    http::async_read_header(on.link, on.buffer, parser,
                            [done](error_code error, std::size_t) { done(error); });
  });
  if (read && !*read && too_large()) read = error_code(http::error::body_limit);
  if (read && !*read) {
    read = beast_io::run_until(on.io, stream, deadline.at, [&](auto done) {
      http::async_read(on.link, on.buffer, parser,
                       [done](error_code error, std::size_t) { done(error); });
    });
  }
  if (!read) {
    return fail({Fault::kPolicy, "no answer in " + seconds_text(options.timeout), server.name()});
  }
  if (*read) {
    const bool is_silent =
        on.buffer.size() == 0 && !parser.got_some() && beast_io::is_cut_off(*read);
    const Failure failure{Fault::kPolicy, is_silent ? beast_io::kCutAtOnce : reason(*read, options),
                          server.name()};
    if (parser.is_header_done()) return fail(failure);
    Outcome outcome = fail(failure);
    outcome.is_headless = true;
    outcome.is_stale = !parser.got_some() && on.buffer.size() == 0;
    return outcome;
  }
  auto& answer = parser.get();
  Outcome outcome;
  outcome.is_kept = wants_to_keep && answer.keep_alive() && on.buffer.size() == 0 && !*written;
  outcome.response.emplace();
  HttpResponse& response = *outcome.response;
  response.status = answer.result_int() > 999 ? 0 : static_cast<int>(answer.result_int());
  response.location = std::string(answer[http::field::location]);
  const auto type = answer[http::field::content_type];
  response.content_type.assign(type.data(), type.size());
  if (const auto after = answer.find(http::field::retry_after); after != answer.end())
    response.retry_after = std::string(after->value().data(), after->value().size());
  response.body = std::move(answer.body());
  return outcome;
}

// What listens there may speak TLS, if nothing that is HTTP came.
Failure said(Outcome outcome, const Endpoint& server, const HttpOptions& options,
             beast_io::Clock::time_point limit) {
  if (!outcome.is_headless) return std::move(*outcome.failure);
  return beast_io::unless_tls(std::move(*outcome.failure), server, {limit, options.timeout},
                              options.resolver, "https://");
}

Result<HttpResponse> exchange(const Endpoint& server, const HttpRequest& request,
                              const HttpOptions& options) {
  HttpTalk on;
  PROBE_TRY(on.link.open(on.io, server, beast_io::Deadline::in(options.connect_timeout),
                         options.resolver));
  const auto limit = beast_io::Clock::now() + options.timeout;
  Outcome outcome = talk(on, server, request, options, false);
  if (outcome.response) return std::move(*outcome.response);
  return said(std::move(outcome), server, options, limit);
}

}  // namespace

std::string sent_elsewhere(unsigned status, std::string_view location, bool is_websocket) {
  constexpr unsigned kSentFrom = 300, kSentBefore = 400;
  if (status < kSentFrom || status >= kSentBefore || location.empty()) return "";
  // What stands behind a question mark may be a secret.
  std::string place(location.substr(0, location.find('?')));
  if (is_websocket && place.starts_with("http")) place.replace(0, 4, "ws");
  return ", which sends to `" + printable(place, 200) + "`: let the address name that";
}

Result<HttpResponse> http_exchange(const Endpoint& server, const HttpRequest& request,
                                   const HttpOptions& options) {
  try {
    return exchange(server, request, options);
  } catch (const std::exception& error) {
    return Failure{Fault::kPolicy, error.what(), server.name()};
  }
}

HttpConnection::HttpConnection(Endpoint server, HttpOptions options)
    : server_(std::move(server)), options_(std::move(options)) {}
HttpConnection::~HttpConnection() = default;

Result<HttpResponse> HttpConnection::exchange(const HttpRequest& request) {
  try {
    for (;;) {
      const bool is_used = open_ != nullptr;
      // Taken out until it is known to be of further use.
      std::unique_ptr<HttpTalk> on = std::move(open_);
      if (!on) {
        reached_ = false;
        on = std::make_unique<HttpTalk>();
        PROBE_TRY(on->link.open(on->io, server_, beast_io::Deadline::in(options_.connect_timeout),
                                options_.resolver));
      }
      reached_ = true;
      const auto limit = beast_io::Clock::now() + options_.timeout;
      Outcome outcome = talk(*on, server_, request, options_, true);
      if (outcome.is_stale && is_used) continue;
      if (!outcome.response) return said(std::move(outcome), server_, options_, limit);
      if (outcome.is_kept) open_ = std::move(on);
      return std::move(*outcome.response);
    }
  } catch (const std::exception& error) {
    return Failure{Fault::kPolicy, error.what(), server_.name()};
  }
}

}  // namespace probe::wire
