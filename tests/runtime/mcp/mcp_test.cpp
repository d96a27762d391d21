// Tools for coding agents: by the protocol's own client, and whatever comes on a line.
#include <doctest/doctest.h>
#include <unistd.h>

#include <algorithm>
#include <thread>

#include "runtime/mcp/server.h"
#include "tests/node_program.h"
#include "tests/runtime/run/temporary_folder.h"

namespace probe::mcp {
namespace {

TEST_CASE("the protocol's own client calls every tool, and each answer fits the tool's schema") {
  const run::TemporaryFolder folder;
  const test::ShellOutcome said =
      test::run_node("tests/runtime/mcp/client.mjs",
                     "'" VLAPROBE_BINARY_DIR "/outside/node_modules' '" VLAPROBE_BINARY_DIR
                     "/vlaprobe' '" VLAPROBE_SOURCE_DIR "/suite/intact.probe' '" +
                         folder.path + "'",
                     300);
  CHECK_MESSAGE(said.status == 0, said.words);
}

TEST_CASE("what is no request is answered as such, and a notification is not") {
  const auto tools = Tools::make("/bin/false");
  const auto code = [&](std::string_view line) {
    const auto said = answer(*tools, line);
    if (!said) return 0;
    const Json json = Json::parse(*said);
    CHECK(json["jsonrpc"] == "2.0");
    return json.contains("error") ? json["error"]["code"].get<int>() : 1;
  };
  CHECK(code("{") == -32700);
  CHECK(code("\xff\xfe") == -32700);
  CHECK(code("[]") == -32600);
  CHECK(code("7") == -32600);
  CHECK(code(R"({"id":1})") == -32600);
  CHECK(code(R"({"jsonrpc":"2.0","id":{},"method":"ping"})") == -32600);
  CHECK(code(R"({"jsonrpc":"2.0","id":1,"method":"resources/list"})") == -32601);
  CHECK(code(R"({"jsonrpc":"2.0","id":1,"method":"tools/call"})") == -32602);
  CHECK(code(R"({"jsonrpc":"2.0","id":1,"method":"tools/call","params":7})") == -32602);
  CHECK(code(R"({"jsonrpc":"2.0","id":1,"method":"ping"})") == 1);
  CHECK(code(R"({"jsonrpc":"2.0","method":"notifications/initialized"})") == 0);
  CHECK(code(R"({"jsonrpc":"2.0","id":1,"result":{}})") == 0);
}

TEST_CASE("the newest version that both know is spoken") {
  const auto tools = Tools::make("/bin/false");
  const auto spoken = [&](const std::string& wanted) {
    const auto said = answer(*tools, R"({"jsonrpc":"2.0","id":"a","method":"initialize","params":{"protocolVersion":")" + wanted + R"("}})");
    return Json::parse(said.value())["result"]["protocolVersion"].text();
  };
  CHECK(spoken("2024-11-05") == "2024-11-05");
  CHECK(spoken("2030-01-01") == "2025-06-18");
  CHECK(spoken("") == "2025-06-18");
}

TEST_CASE("lines are answered one by one, and one that is too long is refused alone") {
  int in[2], out[2];
  REQUIRE(::pipe(in) == 0);
  REQUIRE(::pipe(out) == 0);
  std::thread server([&] {
    const auto tools = Tools::make("/bin/false");
    serve(in[0], out[1], *tools);
    ::close(out[1]);
  });
  std::thread writer([&] {
    const std::string ping = R"({"jsonrpc":"2.0","id":1,"method":"ping"})";
    const std::string text = "\n" + ping + "\r\n" + std::string(5 << 20, 'x') + "\n" + ping + "\n" + ping;
    for (std::size_t at = 0; at < text.size();) {
      const auto put = ::write(in[1], text.data() + at, text.size() - at);
      if (put <= 0) break;
      at += static_cast<std::size_t>(put);
    }
    ::close(in[1]);
  });
  std::string said;
  char buffer[4096];
  for (ssize_t n; (n = ::read(out[0], buffer, sizeof buffer)) > 0;)
    said.append(buffer, static_cast<std::size_t>(n));
  writer.join();
  server.join();
  CHECK(std::count(said.begin(), said.end(), '\n') == 3);  // the last line had no end
  CHECK(said.find("4 MiB at most") != std::string::npos);
}

}  // namespace
}  // namespace probe::mcp
