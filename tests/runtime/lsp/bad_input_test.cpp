// What an editor, or somebody beside it, does that nobody wants.
#include <doctest/doctest.h>
#include <fcntl.h>
#include <unistd.h>

#include <filesystem>
#include <random>
#include <thread>

#include "runtime/lsp/common_ends.h"
#include "runtime/lsp/frames.h"
#include "runtime/lsp/stdio.h"
#include "tests/runtime/lsp/client.h"

using namespace probe;
using namespace probe::test;
namespace fs = std::filesystem;

namespace {

const std::string kSuite = VLAPROBE_SOURCE_DIR "/suite";
const std::string kIntact = kSuite + "/intact.probe";

// `vlaprobe lsp` in a thread, between two pipes.
class Served {
 public:
  Served() {
    int in[2], out[2];
    REQUIRE(::pipe2(in, O_CLOEXEC) == 0);
    REQUIRE(::pipe2(out, O_CLOEXEC) == 0);
    to_ = in[1];
    from_ = out[0];
    thread_ = std::thread([this, read = in[0], write = out[1]] {
      const auto code = lsp::serve(
          read, write, {.assets = "", .library = "", .pause = std::chrono::milliseconds(1)});
      code_ = code ? *code : -1;
      ::close(read);
      ::close(write);
    });
  }
  ~Served() { end(); }
  // Of the program, once it has ended.
  int end() {
    stop_writing();
    stop_reading();
    if (thread_.joinable()) thread_.join();
    return code_;
  }
  void write(const std::string& bytes) {
    for (std::size_t at = 0; at < bytes.size();) {
      const ssize_t size = ::write(to_, bytes.data() + at, bytes.size() - at);
      if (size <= 0) return;
      at += static_cast<std::size_t>(size);
    }
  }
  void say(const char* method, Json params, int id = 0) {
    Json message = {{"jsonrpc", "2.0"}, {"method", method}, {"params", std::move(params)}};
    if (id != 0) message["id"] = id;
    write(lsp::framed(message.dump()));
  }
  // The next message; null at the end of all.
  Json read() {
    char buffer[4096];
    while (true) {
      if (const auto frame = frames_.next()) return Json::parse(frame->message);
      const ssize_t size = ::read(from_, buffer, sizeof buffer);
      if (size <= 0) return Json();
      frames_.add({buffer, static_cast<std::size_t>(size)});
    }
  }
  void stop_writing() {
    if (to_ >= 0) ::close(to_);
    to_ = -1;
  }
  void stop_reading() {
    if (from_ >= 0) ::close(from_);
    from_ = -1;
  }

 private:
  int to_ = -1, from_ = -1;
  int code_ = -1;
  lsp::FrameReader frames_;
  std::thread thread_;
};

}  // namespace

TEST_CASE("what two texts begin and end with does not overlap") {
  const auto ends = [](std::string_view a, std::string_view b) {
    const lsp::CommonEnds found = lsp::common_ends(a, b);
    return std::to_string(found.front) + " " + std::to_string(found.back);
  };
  CHECK(ends("", "") == "0 0");
  CHECK(ends("abc", "abc") == "3 0");
  CHECK(ends("abc", "abxc") == "2 1");
  CHECK(ends("aa", "aaa") == "2 0");
  CHECK(ends("xay", "xby") == "1 1");
  CHECK(ends("abc", "xyz") == "0 0");
}

TEST_CASE("any bytes on the input are answered by mistakes, and what follows is a message again") {
  std::mt19937 random(7);
  for (int round = 0; round < 40; ++round) {
    CAPTURE(round);
    Served served;
    std::string bytes;
    for (int i = 0; i < 300; ++i) bytes += static_cast<char>(random() & 0xff);
    // A header's line ends; a body as long as it says is no JSON.
    if (round % 2 == 0) bytes = lsp::framed(bytes);
    else bytes += "\r\n\r\n";
    served.write(bytes);
    served.say("initialize", {{"rootUri", Json()}, {"capabilities", Json::object()}}, 1);
    served.say("shutdown", Json(), 2);
    served.say("exit", Json());
    bool is_initialized = false, has_mistake = false;
    while (true) {
      const Json answer = served.read();
      if (answer.is_null()) break;
      if (answer.contains("error")) has_mistake = true;
      const Json* id = answer.find("id");
      if (id != nullptr && *id == Json(1)) is_initialized = answer.contains("result");
    }
    CHECK(has_mistake);
    CHECK(is_initialized);
    CHECK(served.end() == 0);
  }
}

TEST_CASE("an input that ends in the middle of a message ends the program") {
  Served served;
  served.write("Content-Length: 100\r\n\r\n{\"jsonrpc\"");
  served.stop_writing();
  CHECK(served.read().is_null());
  CHECK(served.end() == 1);
}

TEST_CASE("an editor that answers nothing that it is asked is served on") {
  const Json capabilities = {
      {"textDocument", {{"diagnostic", Json::object()}}},
      {"workspace",
       {{"diagnostics", {{"refreshSupport", true}}},
        {"didChangeWatchedFiles", {{"dynamicRegistration", true}}}}}};
  Editor editor(kSuite, std::chrono::milliseconds(1), capabilities);
  std::string text = text_of_file(kIntact);
  editor.open(kIntact, text);
  for (int i = 0; i < 20; ++i) {
    text += "# more\n";
    editor.change(kIntact, text);
    REQUIRE(editor.server().wait_checked(std::chrono::seconds(60)));
  }
  int asked = 0;
  for (const Json& message : editor.messages())
    asked += message.contains("id") && message.contains("method") ? 1 : 0;
  CHECK(asked >= 20);  // one to watch files, and one at each check, none of them answered
  CHECK(editor.ask("textDocument/hover",
                   Editor::at(kIntact, place_of(text, "carrot_on_plate like")))
            .contains("contents"));
}

TEST_CASE("an editor that reads nothing and goes away leaves no server behind") {
  Served served;
  served.say("initialize", {{"rootUri", Json()}, {"capabilities", Json::object()}}, 1);
  const std::string text = text_of_file(kIntact);
  served.say("textDocument/didOpen", {{"textDocument",
                                       {{"uri", lsp::uri_of(kIntact)},
                                        {"languageId", "probe"},
                                        {"version", 1},
                                        {"text", text}}}});
  // Answers beyond what the pipe holds: the server waits for somebody to read them.
  std::thread asking([&] {
    for (int i = 2; i < 40; ++i)
      served.say("textDocument/semanticTokens/full", Editor::document(kIntact), i);
  });
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  served.stop_reading();
  asking.join();
  CHECK(served.end() == 1);
}

TEST_CASE("a text outside of the folders is checked, and nothing outside is changed") {
  Folder inside, outside;
  const std::string things =
      outside.write("things.probe", "attribute color { red }\nobject ball { color red }\n");
  const std::string user = inside.write(
      "user.probe", "use \"" + things + "\"\nobject other like ball { color red }\n");
  Editor editor(inside.path());
  editor.open(user, text_of_file(user));
  Json rename = Editor::at(user, place_of(text_of_file(user), "ball"));
  rename["newName"] = "globe";
  CHECK(editor.ask("textDocument/rename", rename)["error"]["message"].text() ==
        "`ball` stands in a text outside of the folder: " + things);
  // What is open is the editor's, wherever it lies.
  editor.open(things, text_of_file(things));
  CHECK(editor.ask("textDocument/rename", rename)["changes"].items().size() == 2);
  CHECK(text_of_file(things).find("globe") == std::string::npos);
  for (const char* uri : {"file:///etc/../etc/hostname", "file://elsewhere/a.probe", "http://a/b",
                          "file:///%00", "file:"}) {
    CAPTURE(uri);
    const Json document = {{"textDocument", {{"uri", uri}}}};
    CHECK(editor.ask("textDocument/documentSymbol", document).contains("error"));
  }
}

TEST_CASE("a text that is deleted while it is open is the editor's, until that closes it") {
  Folder folder;
  const std::string things = folder.write("things.probe", "object ball { friction 1 }\n");
  const std::string user = folder.write("user.probe", "use \"things.probe\"\n");
  Editor editor(folder.path());
  editor.open(things, text_of_file(things));
  editor.open(user, text_of_file(user) + "object other like ball { friction 2 }\n");
  const std::string before = editor.codes(user);
  CHECK(before.find("P0202") == before.npos);
  fs::remove(things);
  editor.tell("workspace/didChangeWatchedFiles", {{"changes", Json::array()}});
  CHECK(editor.codes(user) == before);
  CHECK(editor.ask("textDocument/documentSymbol", Editor::document(things)).size() == 1);
  editor.tell("textDocument/didClose", Editor::document(things));
  CHECK(editor.codes(user).find("P0202") == 0);
}

TEST_CASE("a file that changes on the disk under an open text is not what is checked") {
  Folder folder;
  const std::string path = folder.write("a.probe", "role one\n");
  Editor editor(folder.path());
  editor.open(path, "role one\n");
  folder.write("a.probe", "role {\n");
  editor.tell("workspace/didChangeWatchedFiles", {{"changes", Json::array()}});
  const std::string codes = editor.codes(path);
  CHECK(codes.find("P0101") == codes.npos);
  CHECK(editor.ask("textDocument/documentSymbol", Editor::document(path))[0]["name"].text() ==
        "one");
}

TEST_CASE("a key in a text of five megabytes is answered, before the whole check is done") {
  Folder folder;
  const std::string path = folder.write("big.probe", "");
  std::string text;
  for (std::size_t i = 0; text.size() < (5u << 20); ++i)
    text += "object thing_" + std::to_string(i) + " { friction 0.5; name \"thing\" }\n";
  Editor editor(folder.path(), std::chrono::milliseconds(1));
  editor.open(path, text);
  const Json place = place_of(text, "thing_9 ", 6);
  Json end = place;
  end["character"] = place["character"].get<int>() + 1;
  editor.change(path, place, end, "no");
  editor.server().settle();
  CHECK(editor.published(path) == 2);
  CHECK(editor.ask("textDocument/hover", Editor::at(path, place)).contains("contents"));
}
