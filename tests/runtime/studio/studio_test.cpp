// The studio over real connections: who is answered, and what the page is told.
#include "runtime/studio/studio.h"

#include <doctest/doctest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "runtime/base/json.h"
#include "runtime/lsp/uri.h"
#include "runtime/wire/http.h"
#include "runtime/wire/websocket.h"

using namespace probe;
namespace fs = std::filesystem;

namespace {

constexpr wire::Duration kLong{60'000};

const std::string kText = "use \"" VLAPROBE_SOURCE_DIR
                          "/suite/intact.probe\"\n"
                          "layout mine {\n  place source at (-16cm, -8cm)\n"
                          "  place target at (-12cm, 8cm)\n  orient by rest\n"
                          "  drop 50cm settle 0.5s\n}\n"
                          "task own like carrot_on_plate { layout mine }\n"
                          "variant other of own { source eggplant }\n";

studio::StudioOptions options(const std::string& file, const std::string& port = "0") {
  studio::StudioOptions options;
  options.file = file;
  options.port = port;
  return options;
}
wire::HttpRequest request(const std::string& method, const std::string& path) {
  wire::HttpRequest request;
  request.method = method;
  request.path = path;
  return request;
}

class Page {
 public:
  Page() : root(fs::temp_directory_path() / ("studio_page_" + std::to_string(::getpid()))) {
    fs::remove_all(root);
    fs::create_directories(root);
    std::ofstream(root / "my.probe") << kText;
    auto started = studio::Studio::start(options(path("my.probe")));
    REQUIRE(started);
    studio = std::move(*started);
    address = studio->address();
    endpoint = wire::parse_endpoint(address.substr(5), "80").value();
    path_ = endpoint.path;
  }
  ~Page() {
    studio.reset();
    fs::remove_all(root);
  }

  std::string path(const std::string& name) const { return (root / name).string(); }
  wire::HttpResponse get(const std::string& name,
                         std::vector<std::pair<std::string, std::string>> headers = {}) const {
    wire::HttpRequest asked = request("GET", path_ + name);
    asked.headers = std::move(headers);
    auto answer = wire::http_exchange(endpoint, asked);
    REQUIRE(answer);
    return *answer;
  }
  Result<std::unique_ptr<wire::WebSocket>> talk(
      const std::string& name,
      std::vector<std::pair<std::string, std::string>> headers = {}) const {
    wire::Endpoint there = endpoint;
    there.path = path_ + name;
    wire::WebSocketOptions with;
    with.headers = std::move(headers);
    return wire::WebSocket::connect(there, with);
  }

  fs::path root;
  std::unique_ptr<studio::Studio> studio;
  std::string address;
  wire::Endpoint endpoint;

 private:
  std::string path_;  // with the token
};

void say(wire::WebSocket& socket, const Json& json) {
  const std::string text = json.dump();
  REQUIRE(socket.send(std::span(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()),
                      kLong));
}

struct Heard {
  Json json;
  std::size_t pixels = 0;  // bytes of pictures behind it
};

// The next message of that kind; others are passed over.
Heard hear(wire::WebSocket& socket, const std::string& kind) {
  while (true) {
    const auto message = socket.receive(kLong);
    REQUIRE_MESSAGE(message, kind, " never came");
    Heard heard;
    if (message->is_text) {
      heard.json = Json::parse(message->text());
    } else {
      const auto& bytes = message->bytes;
      const std::size_t size = bytes[0] | bytes[1] << 8 | bytes[2] << 16;
      heard.json =
          Json::parse(std::string_view(reinterpret_cast<const char*>(bytes.data()) + 4, size));
      heard.pixels = bytes.size() - 4 - size;
    }
    if (heard.json.value("kind", "") == kind) return heard;
  }
}

}  // namespace

TEST_CASE("the page is served to its own address and to nobody else") {
  const Page page;
  CHECK(page.get("").status == 200);
  CHECK(page.get("page.js").content_type == "text/javascript; charset=utf-8");
  CHECK(page.get("worker.js").status == 200);
  CHECK(page.get("../../../../etc/passwd").status == 404);
  CHECK(page.get("my.probe").status == 404);
  wire::Endpoint bare = page.endpoint;
  CHECK(wire::http_exchange(bare, request("GET", "/"))->status == 403);
  CHECK(wire::http_exchange(bare, request("POST", page.endpoint.path))->status == 405);
  CHECK(page.get("", {{"Origin", "http://evil.example"}}).status == 403);
}

TEST_CASE("a conversation needs the token and our own origin") {
  const Page page;
  CHECK(page.talk("live"));
  CHECK(page.talk("live", {{"Origin", page.address.substr(0, page.address.find('/', 7))}}));
  CHECK_FALSE(page.talk("live", {{"Origin", "http://evil.example"}}));
  CHECK_FALSE(page.talk("nothing"));
  wire::Endpoint bare = page.endpoint;
  bare.path = "/live";
  CHECK_FALSE(wire::WebSocket::connect(bare));
}

TEST_CASE("a second page is told that there is a first, and may take over") {
  const Page page;
  auto first = page.talk("live").value();
  say(*first, {{"do", "hello"}});
  CHECK(hear(*first, "welcome").json["file"] == page.path("my.probe"));
  auto second = page.talk("live").value();
  say(*second, {{"do", "hello"}});
  hear(*second, "taken");
  say(*second, {{"do", "open"}, {"path", page.path("my.probe")}});
  CHECK(hear(*second, "refused").json["message"] == "another page shows this studio");
  say(*second, {{"do", "take"}});
  hear(*second, "welcome");
  hear(*first, "lost");
  CHECK_FALSE(first->receive(kLong));  // it is ended
  first.reset();
  say(*second, {{"do", "open"}, {"path", page.path("my.probe")}});
  CHECK(hear(*second, "text").json["text"] == kText);
}

TEST_CASE("a text becomes a picture, small and then whole, its tasks and its starts from above") {
  const Page page;
  auto live = page.talk("live").value();
  say(*live, {{"do", "hello"}});
  say(*live, {{"do", "show"}, {"id", 7}, {"texts", Json::object()}, {"task", ""}, {"start", 0}});
  const Heard small = hear(*live, "picture");
  CHECK(small.json["size"] == "small");
  CHECK(small.json["task"] == "own");  // the text's own, not those that it uses
  CHECK(small.pixels == 160u * 120u * 4u);
  const Heard full = hear(*live, "picture");
  CHECK(full.json["size"] == "full");
  CHECK(full.pixels == 640u * 480u * 4u);
  const Json summary = hear(*live, "tasks").json["summary"];
  const Json* own = nullptr;
  const Json* other = nullptr;
  for (const Json& task : summary["tasks"]) {
    if (task["name"] == "own") own = &task;
    if (task["name"] == "other") other = &task;
  }
  REQUIRE(own != nullptr);
  REQUIRE(other != nullptr);
  CHECK((*own)["words"] ==
        Json::parse(R"([{"words": "carrot", "object": "carrot", "role": "source"},
                        {"words": "plate", "object": "plate", "role": "target"}])"));
  CHECK((*own)["baseline"].is_null());
  CHECK((*other)["baseline"] == "own");
  CHECK((*other)["axes"].size() >= 1);
  CHECK((*own)["is_own"] == true);
  CHECK(hear(*live, "top").json["svg"].text().find("data-object=\"carrot\"") != std::string::npos);
}

TEST_CASE("a model beside the text is drawn, seen from above and played with") {
  const Page page;
  fs::create_directories(page.root / "assets/objects");
  fs::copy(VLAPROBE_SOURCE_DIR "/assets/objects/plate", page.root / "assets/objects/my_plate");
  auto live = page.talk("live").value();
  say(*live, {{"do", "hello"}});
  const std::string text = kText +
                           "object mine like plate { mesh \"my_plate\"; name \"my plate\" }\n"
                           "task near like own { target mine; horizon 8 steps }\n";
  Json texts = Json::object();
  texts[page.path("my.probe")] = text;
  say(*live, {{"do", "show"}, {"id", 7}, {"texts", texts}, {"task", "near"}, {"start", 0}});
  CHECK(hear(*live, "picture").json["task"] == "near");
  CHECK(hear(*live, "top").json["svg"].text().find("data-object=\"mine\"") != std::string::npos);
  say(*live, {{"do", "play"}, {"task", "near"}, {"start", 0}, {"policy", "null"}, {"seed", 0}});
  CHECK(hear(*live, "played").json["steps"] == Json(8));
}

TEST_CASE("what is typed and not saved is what is shown; a mistake says where it is") {
  const Page page;
  auto live = page.talk("live").value();
  say(*live, {{"do", "hello"}});
  std::string typed = kText;
  typed.replace(typed.find("task own"), 8, "task new");
  typed.replace(typed.find("of own"), 6, "of new");
  const auto show = [&](int id, const std::string& text) {
    Json texts = Json::object();
    texts[page.path("my.probe")] = text;
    say(*live, {{"do", "show"}, {"id", id}, {"texts", texts}, {"task", ""}, {"start", 1}});
  };
  show(1, typed);
  hear(*live, "picture");
  const Heard full = hear(*live, "picture");
  CHECK(full.json["task"] == "new");
  CHECK(full.json["start"] == 1);
  show(2, typed + "task broken {");
  const Heard broken = hear(*live, "broken");
  CHECK(broken.json["id"] == 2);
  CHECK(broken.json["line"] == 10);
  CHECK(broken.json["file"] == page.path("my.probe"));
  show(3, "");
  CHECK(hear(*live, "failed").json["message"] == "the text has no task yet");
}

TEST_CASE("a used text that another program writes is shown as it is now") {
  const Page page;
  const auto write = [&](const std::string& name, const std::string& text) {
    std::ofstream(page.path(name), std::ios::binary) << text;
  };
  write("used.probe", "light lamp { ambient 0.5 }\n");
  auto live = page.talk("live").value();
  say(*live, {{"do", "hello"}});
  Json texts = Json::object();
  texts[page.path("my.probe")] = "use \"used.probe\"\n" + std::string(kText);
  const auto show = [&](int id) {
    say(*live, {{"do", "show"}, {"id", id}, {"texts", texts}, {"task", ""}, {"start", 0}});
  };
  show(1);
  hear(*live, "top");
  write("used.probe", "light lamp { ambient 0.5 \n");
  show(2);
  CHECK(hear(*live, "broken").json["id"] == 2);
}

TEST_CASE("an episode is watched, looked at again and explained") {
  const Page page;
  auto live = page.talk("live").value();
  say(*live, {{"do", "hello"}});
  say(*live, {{"do", "play"}, {"task", "own"}, {"policy", "expert"}, {"start", 0}});
  CHECK(hear(*live, "stopped").json["message"] == "the text has to check before it is played");
  say(*live, {{"do", "show"}, {"id", 1}, {"texts", Json::object()}, {"task", "own"}, {"start", 0}});
  hear(*live, "tasks");
  say(*live, {{"do", "play"}, {"task", "own"}, {"policy", "nobody"}, {"start", 0}});
  CHECK(hear(*live, "stopped").json["message"].text().starts_with("--policy: unknown policy"));
  say(*live, {{"do", "play"}, {"task", "own"}, {"policy", "expert"}, {"start", 99}});
  CHECK(hear(*live, "stopped").json["message"] == "own: has no start 99");
  say(*live, {{"do", "play"}, {"task", "own"}, {"policy", "expert"}, {"start", 0}});
  const Json playing = hear(*live, "playing").json;
  CHECK(playing["metrics"][0]["name"] == "success");
  CHECK(hear(*live, "step").json["step"] == 0);
  const Json played = hear(*live, "played").json;
  CHECK(played["invalid"].is_null());
  CHECK(played["values"][0] == 1);
  say(*live, {{"do", "look"}, {"step", 3}});
  const Heard moment = hear(*live, "moment");
  CHECK(moment.json["step"] == 3);
  CHECK(moment.pixels == 640u * 480u * 4u);
  // A step becomes a table that checks, and its first picture is that step's.
  say(*live, {{"do", "keep"}, {"step", 99999}});
  CHECK(hear(*live, "refused").json["message"] == "there is no episode with such a step");
  say(*live, {{"do", "keep"}, {"step", 3}});
  const Json kept = hear(*live, "kept").json;
  CHECK(kept["table"] == "my_kept_1.csv");
  Json texts = Json::object();
  texts[page.path("my.probe")] = kText + kept["lines"].text();
  say(*live, {{"do", "show"}, {"id", 9}, {"texts", texts}, {"task", kept["task"]}, {"start", 0}});
  CHECK(hear(*live, "picture").json["task"] == "own_kept_1");
  say(*live, {{"do", "why"}, {"metric", "success"}});
  const Json why = hear(*live, "why").json;
  REQUIRE(why["metrics"].size() == 1);
  CHECK(why["metrics"][0]["metric"] == "success");
  CHECK(why["metrics"][0]["conditions"].size() > 0);
  say(*live, {{"do", "why"}, {"metric", "nothing"}});
  CHECK(hear(*live, "why").json["message"].text().find("nothing") != std::string::npos);
}

TEST_CASE("any bytes are answered, and the studio goes on") {
  const Page page;
  auto live = page.talk("live").value();
  const auto send = [&](const std::string& text) {
    REQUIRE(live->send(std::span(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()),
                       kLong));
  };
  for (const char* text : {"", "{", "[]", "null", "{\"do\": 3}", "\xff\xfe", "{\"do\": \"fly\"}"}) {
    CAPTURE(text);
    send(text);
    hear(*live, "refused");
  }
  say(*live, {{"do", "hello"}});
  hear(*live, "welcome");
  say(*live, {{"do", "fly"}});
  CHECK(hear(*live, "refused").json["message"] == "there is no `fly`");
  say(*live, {{"do", "save"}, {"path", page.path("my.probe")}});
  CHECK(hear(*live, "refused").json["message"] == "`save` needs a `text`");
  say(*live, {{"do", "open"}, {"path", "/etc/passwd"}});
  CHECK(hear(*live, "refused").json["path"] == "/etc/passwd");
  // Numbers that are none, paths of other folders, a text of another kind.
  Json texts = Json::object();
  texts["/etc/passwd"] = "x";
  texts[page.path("my.probe")] = 3;
  say(*live, {{"do", "show"}, {"id", "x"}, {"texts", texts}, {"task", 3}, {"start", -1e300}});
  CHECK(hear(*live, "picture").json["task"] == "own");
}

TEST_CASE("a text of five megabytes is shown or told, and the next one is shown") {
  const Page page;
  auto live = page.talk("live").value();
  say(*live, {{"do", "hello"}});
  Json texts = Json::object();
  texts[page.path("my.probe")] = kText + "#" + std::string(5 << 20, 'x') + "\n";
  say(*live, {{"do", "show"}, {"id", 1}, {"texts", texts}, {"task", ""}, {"start", 0}});
  const auto answer = live->receive(kLong);
  REQUIRE(answer);
  say(*live, {{"do", "show"}, {"id", 2}, {"texts", Json::object()}, {"task", ""}, {"start", 0}});
  while (hear(*live, "picture").json["id"] != Json(2)) {
  }
}

TEST_CASE("the editor's language server answers for texts of the folder alone") {
  const Page page;
  auto text = page.talk("text").value();
  const auto ask = [&](const std::string& method, const Json& params) {
    say(*text, {{"jsonrpc", "2.0"}, {"id", 1}, {"method", method}, {"params", params}});
    while (true) {
      const auto message = text->receive(kLong);
      REQUIRE(message);
      const Json json = Json::parse(message->text());
      if (json.contains("id")) return json;
    }
  };
  const auto open = [&](const std::string& path, const std::string& words) {
    const Json document = {{"uri", lsp::uri_of(path)}, {"version", 1}, {"text", words}};
    say(*text, {{"jsonrpc", "2.0"},
                {"method", "textDocument/didOpen"},
                {"params", {{"textDocument", document}}}});
  };
  CHECK(ask("initialize", {{"rootUri", "file:///"}, {"capabilities", Json::object()}})
            .contains("result"));
  // Another spelling of the same letters is the same message.
  const std::string hosts = lsp::uri_of("/etc/hosts.probe");
  const std::string spelled =
      R"({"jsonrpc": "2.0", "method": "textDocument/d\u0069dOpen", "params": {"textDocument": )"
      R"({"uri": ")" +
      hosts + R"(", "version": 1, "text": "suite x { }"}}})";
  REQUIRE(text->send(
      std::span(reinterpret_cast<const std::uint8_t*>(spelled.data()), spelled.size()), kLong));
  while (true) {
    const auto message = text->receive(kLong);
    REQUIRE(message);
    const Json json = Json::parse(message->text());
    if (json.value("method", "") != "window/showMessage") continue;
    CHECK(
        json["params"]["message"].text().starts_with("/etc/hosts.probe is no text of the folder"));
    break;
  }
  open(page.path("my.probe"), kText);
  const Json document = {{"uri", lsp::uri_of(page.path("my.probe"))}};
  const auto move = [&](const std::string& task, const Json& to) {
    return ask("vlaprobe/move", {{"textDocument", document},
                                 {"task", task},
                                 {"object", "carrot"},
                                 {"from", Json::parse("[-0.16, -0.08]")},
                                 {"to", to}});
  };
  const Json moved = move("own", Json::parse("[-0.15, -0.08]"));
  const Json& edits = moved["result"]["changes"][lsp::uri_of(page.path("my.probe"))];
  REQUIRE(edits.size() == 1);
  CHECK(edits[0]["newText"] == "-15cm");
  CHECK(edits[0]["range"]["start"]["line"] == 2);
  CHECK(move("own", "far")["error"]["message"] == "expected `from` and `to`, places in m");
  // The layout of the suite is not this folder's to change.
  const Json outside = move("carrot_on_plate", Json::parse("[-0.15, -0.08]"));
  CHECK(outside["error"]["message"].text().find("outside of the folder") != std::string::npos);
}

TEST_CASE("a port that is taken is told") {
  const Page page;
  const auto again = studio::Studio::start(options(page.path("my.probe"), page.endpoint.port));
  REQUIRE_FALSE(again);
  CHECK(again.failure().code == Fault::kUsage);
}

TEST_CASE("a studio goes while pages talk to it") {
  auto page = std::make_unique<Page>();
  auto live = page->talk("live").value();
  auto text = page->talk("text").value();
  say(*live, {{"do", "hello"}});
  hear(*live, "welcome");
  say(*live, {{"do", "show"}, {"id", 1}, {"texts", Json::object()}, {"task", ""}, {"start", 0}});
  page.reset();
  while (live->receive(kLong)) {
  }
}
