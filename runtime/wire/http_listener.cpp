// HTTP servers' side, by Boost.Beast: every POST is a message and every connection has one.
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>

#include "runtime/wire/listener.h"
#include "runtime/wire/tcp_listener.h"

namespace probe::wire {
namespace {

namespace http = boost::beast::http;

constexpr std::uint64_t kLargestBody = std::uint64_t{256} << 20;

class HttpListener final : public beast_io::TcpListener {
 public:
  explicit HttpListener(const MakeSpeaker& make) : speaker_(make()) {}
  ~HttpListener() override { stop(); }

 private:
  void serve(beast_io::ServedLink& link) override {
    boost::beast::flat_buffer buffer;
    http::request_parser<http::string_body> parser;
    parser.body_limit(kLargestBody);
    http::read(link, buffer, parser);
    const auto& asked = parser.get();
    http::response<http::string_body> page(http::status::not_found, asked.version());
    page.set(http::field::content_type, "application/json");
    if (asked.method() == http::verb::post) {
      const std::lock_guard lock(talk_);
      const Speaker::Reply reply =
          speaker_->answer({false, Bytes(asked.body().begin(), asked.body().end())});
      page.result(reply.close ? http::status::internal_server_error : http::status::ok);
      for (const Frame& frame : reply.frames)
        page.body().append(frame.bytes.begin(), frame.bytes.end());
    }
    page.keep_alive(false);
    page.prepare_payload();
    http::write(link, page);
    link.end();
  }

  std::mutex talk_;  // the speaker
  std::unique_ptr<Speaker> speaker_;
};

}  // namespace

Result<std::unique_ptr<Listener>> listen_http(const std::string& address, const std::string& port,
                                              MakeSpeaker make, const TlsFiles& tls) {
  auto listener = std::make_unique<HttpListener>(make);
  PROBE_TRY(listener->listen(address, port, tls));
  return std::unique_ptr<Listener>(std::move(listener));
}

}  // namespace probe::wire
