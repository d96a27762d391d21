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
  explicit WebSocketListener(MakeSpeaker make) : make_(std::move(make)) {}
  ~WebSocketListener() override { stop(); }

 private:
  using Stream = websocket::stream<Socket&>;

  void serve(Socket& socket) override {
    beast::flat_buffer buffer;
    beast::http::request<beast::http::string_body> asked;
    beast::http::read(socket, buffer, asked);
    if (!websocket::is_upgrade(asked)) return answer_page(socket, asked);
    Stream stream(socket);
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

  static void answer_page(Socket& socket,
                          const beast::http::request<beast::http::string_body>& asked) {
    const bool is_health = asked.target() == "/healthz";
    beast::http::response<beast::http::string_body> page(
        is_health ? beast::http::status::ok : beast::http::status::not_found, asked.version());
    page.set(beast::http::field::content_type, "text/plain");
    page.body() = is_health ? "OK\n" : "a policy server; speak WebSocket\n";
    page.keep_alive(false);
    page.prepare_payload();
    beast::http::write(socket, page);
  }

  MakeSpeaker make_;
};

}  // namespace

Frame text_frame(std::string_view text) { return {true, Bytes(text.begin(), text.end())}; }

Result<std::unique_ptr<Listener>> listen_websocket(const std::string& address,
                                                   const std::string& port, MakeSpeaker make) {
  auto listener = std::make_unique<WebSocketListener>(std::move(make));
  PROBE_TRY(listener->listen(address, port));
  return std::unique_ptr<Listener>(std::move(listener));
}

}  // namespace probe::wire
