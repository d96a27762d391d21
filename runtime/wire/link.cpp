#include "runtime/wire/link.h"

#include <boost/asio/steady_timer.hpp>

namespace probe::wire::beast_io {
namespace {

// For a look at a server that said something else than was asked.
constexpr Duration kProbePatience{2000};

// For a server to end TLS as we do.
constexpr Duration kEndPatience{100};

}  // namespace

Status Link::open(boost::asio::io_context& io, const Endpoint& server, const Deadline& deadline,
                  const Resolver& resolver) {
  PROBE_TRY(connect_tcp(io, tcp_, server, deadline, resolver));
  if (!server.tls.is_on) return {};
  PROBE_ASSIGN(tls_, TlsStream::over(tcp_.socket(), server));
  const auto agreed = run_until(io, tcp_, deadline.at, [this](auto done) {
    tls_->async_handshake([done](error_code error) { done(error); });
  });
  if (!agreed) {
    return Failure{Fault::kPolicy, "opening TLS took more than " + seconds_text(deadline.stated),
                   server.name()};
  }
  if (*agreed) return tls_->refusal(*agreed);
  return {};
}

void Link::end_tls(std::function<void(error_code)> done) {
  const auto timer = std::make_shared<boost::asio::steady_timer>(tcp_.get_executor(), kEndPatience);
  timer->async_wait([this, timer](error_code error) {
    error_code ignored;
    if (!error) tcp_.socket().cancel(ignored);
  });
  tls_->async_shutdown([timer, done = std::move(done)](error_code) {
    timer->cancel();
    done({});
  });
}

Failure unless_tls(Failure failure, const Endpoint& server, const Deadline& deadline,
                   const Resolver& resolver, const std::string& scheme) {
  const auto left = std::chrono::ceil<Duration>(deadline.at - Clock::now());
  if (server.tls.is_on || left <= Duration(0)) return failure;
  Endpoint asked = server;
  asked.tls = {.is_on = true, .authorities = {}, .accepts_any = true};
  boost::asio::io_context io;
  Link link(io);
  if (!link.open(io, asked, Deadline::in(std::min(left, kProbePatience)), resolver)) return failure;
  return {Fault::kAnswered,
          "the server speaks TLS: its address begins with " + scheme + asked.authority(),
          server.name()};
}

}  // namespace probe::wire::beast_io
