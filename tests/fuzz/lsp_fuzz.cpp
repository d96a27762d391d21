// libFuzzer over the language server: any bytes on its input give answers that are JSON, and no
// end. Bytes are fed as a stream; what begins with `{` is also tried as one message and as the text
// of an open document, at places of which everything is asked.
// links: probe_lsp
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "runtime/base/json.h"
#include "runtime/lsp/frames.h"
#include "runtime/lsp/server.h"

using namespace probe;

namespace {

void tell(lsp::Server& server, const char* method, Json params, int id = 0) {
  Json message = {{"jsonrpc", "2.0"}, {"method", method}};
  if (id != 0) message["id"] = id;
  message["params"] = std::move(params);
  server.receive(message.dump());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  auto server = lsp::Server::start(
      {.assets = VLAPROBE_SOURCE_DIR "/assets",
       .library = VLAPROBE_SOURCE_DIR "/dsl",
       .pause = std::chrono::hours(1)},
      [](std::string message) {
        if (Json::parse(message).is_discarded()) {
          std::fprintf(stderr, "lsp_fuzz: an answer that is no JSON\n");
          std::abort();
        }
      });
  if (!server) return 0;
  tell(**server, "initialize", Json::object(), 1);
  const char* const uri = "file:///fuzz/text.probe";
  tell(**server, "textDocument/didOpen", {{"textDocument", {{"uri", uri}, {"text", bytes}}}});
  (*server)->settle();
  const auto number = [&](std::size_t at) { return at < size ? data[at] : 0; };
  const Json place = {{"line", number(0) % 16}, {"character", number(1)}};
  const Json range = {{"start", place}, {"end", {{"line", number(2)}, {"character", number(3)}}}};
  const Json params = {{"textDocument", {{"uri", uri}}}, {"position", place}, {"range", range},
                       {"newName", "other"}};
  int id = 1;
  for (const char* method :
       {"textDocument/completion", "textDocument/hover", "textDocument/definition",
        "textDocument/references", "textDocument/documentHighlight", "textDocument/rename",
        "textDocument/prepareRename", "textDocument/documentSymbol", "textDocument/formatting",
        "textDocument/codeAction", "textDocument/diagnostic", "textDocument/signatureHelp",
        "textDocument/foldingRange", "textDocument/semanticTokens/full", "textDocument/inlayHint",
        "textDocument/codeLens", "textDocument/documentLink", "workspace/symbol"})
    tell(**server, method, params, ++id);
  const Json change = {{"range", range}, {"text", "x"}};
  tell(**server, "textDocument/didChange",
       {{"textDocument", {{"uri", uri}, {"version", 2}}}, {"contentChanges", Json::array({change})}});
  (*server)->settle();
  (*server)->receive(bytes);
  lsp::FrameReader frames;
  frames.add(bytes);
  for (int i = 0; i < 1000; ++i) {
    const auto frame = frames.next();
    if (!frame) break;
    (*server)->receive(frame->message);
  }
  return 0;
}
