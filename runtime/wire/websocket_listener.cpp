// WebSocket servers' side, by Boost.Beast.
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>

#include "runtime/wire/listener.h"
#include "runtime/wire/tcp_listener.h"

namespace probe::wire {
namespace {

namespace beast = boost::beast;
namespace websocket = beast::websocket;

constexpr std::size_t kLargestQuestion = std::size_t{256} << 20;

class WebSocketListener final : public beast_io::TcpListener {
 public:
  WebSocketListener(MakeSpeaker make, AnswerPage page)
      : make_(std::move(make)), page_(std::move(page)) {}
  ~WebSocketListener() override { stop(); }

 private:
  using Stream = websocket::stream<beast_io::ServedLink&>;

  void serve(beast_io::ServedLink& link) override {
    beast::flat_buffer buffer;
    beast::http::request<beast::http::string_body> asked;
    beast::http::read(link, buffer, asked);
    if (!websocket::is_upgrade(asked)) return answer_page(link, asked);
    Stream stream(link);
    stream.read_message_max(kLargestQuestion);
    stream.auto_fragment(false);
    stream.accept(asked);
    const auto speaker = make_();
    for (const Frame& frame : speaker->greet()) send(stream, frame);
    while (true) {
      beast::flat_buffer message;
      stream.read(message);
      const auto* data = static_cast<const std::uint8_t*>(message.data().data());
      const Speaker::Reply reply =
          speaker->answer({stream.got_text(), Bytes(data, data + message.size())});
      for (const Frame& frame : reply.frames) send(stream, frame);
      if (!reply.close) continue;
      stream.close({websocket::close_code::internal_error, reply.close->substr(0, 120)});
      return;
    }
  }

  static void send(Stream& stream, const Frame& frame) {
    stream.text(frame.is_text);
    stream.write(boost::asio::buffer(frame.bytes));
  }

  void answer_page(beast_io::ServedLink& link,
                   const beast::http::request<beast::http::string_body>& asked) const {
    const std::string target(asked.target());
    Page said{404, "text/plain", "a policy server; speak WebSocket\n"};
    if (target == "/healthz") {
      said = {200, "text/plain", "OK\n"};
    } else if (auto own = page_ ? page_(target) : std::nullopt) {
      said = std::move(*own);
    }
    beast::http::response<beast::http::string_body> page(
        beast::http::int_to_status(static_cast<unsigned>(said.status)), asked.version());
    page.set(beast::http::field::content_type, said.type);
    page.body() = std::move(said.body);
    page.keep_alive(false);
    page.prepare_payload();
    beast::http::write(link, page);
    link.end();
  }

  MakeSpeaker make_;
  AnswerPage page_;
};

}  // namespace

Frame text_frame(std::string_view text) { return {true, Bytes(text.begin(), text.end())}; }

Result<std::unique_ptr<Listener>> listen_websocket(const std::string& address,
                                                   const std::string& port, MakeSpeaker make,
                                                   const TlsFiles& tls, AnswerPage page) {
  auto listener = std::make_unique<WebSocketListener>(std::move(make), std::move(page));
  PROBE_TRY(listener->listen(address, port, tls));
  return std::unique_ptr<Listener>(std::move(listener));
}

}  // namespace probe::wire
