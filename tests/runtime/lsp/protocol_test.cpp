// A real editor, and ours for what it cannot: what they do with the answers, and every message held
// to the protocol's own types (protocol/check.mjs).
#include <doctest/doctest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "runtime/lsp/frames.h"
#include "tests/runtime/lsp/client.h"

using namespace probe;
using namespace probe::test;
namespace fs = std::filesystem;

namespace {

const std::string kProtocol = VLAPROBE_SOURCE_DIR "/tests/runtime/lsp/protocol";
const std::string kPackages = VLAPROBE_BINARY_DIR "/lsp_protocol";
const std::string kThings =
    "# Things.\nattribute color { red, blue }\nobject ball { color red; friction 1 }\n";
const std::string kUser =
    "use \"things.probe\"\nobject other like bal { color blue }\n"
    "predicate near2(a: object, b: object) = distance(a, b) < 2cm\n"
    "suite mine { tasks tasks; seeds 1 }\n";

bool has(const char* program) {
  return std::system(("command -v " + std::string(program) + " >/dev/null 2>&1").c_str()) == 0;
}

// What check.mjs says of what was said, nothing where node is too old to make the schema; mistakes of another's editor are told and do not count.
std::string held(const Folder& folder, const char* whose) {
  if (std::system("node -e 'process.exit(parseInt(process.versions.node) < 20 ? 1 : 0)'") != 0) {
    MESSAGE("SKIPPED: messages are not held to the schema, node is older than 20");
    return {};
  }
  const std::string told = folder.path() + "/checked";
  const std::string line = "node '" + kProtocol + "/check.mjs' '" + kPackages + "' '" +
                           folder.path() + "/from_editor' '" + folder.path() + "/from_server' " + whose + " >'" + told + "' 2>&1";
  const int status = std::system(line.c_str());
  const std::string text = text_of_file(told);
  CHECK_MESSAGE(status == 0, text);
  return text;
}

}  // namespace

TEST_CASE("Neovim is answered all that it can ask, as the protocol has it") {
  if (!has("nvim")) {
    MESSAGE("SKIPPED: nvim is not here");
    return;
  }
  const Folder folder;
  fs::create_directory(folder.path() + "/texts");
  folder.write("texts/things.probe", kThings);
  folder.write("texts/user.probe", kUser);
  const std::string line =
      "cd '" + folder.path() + "' && HOME='" + folder.path() + "' XDG_CONFIG_HOME='" +
      folder.path() + "' VLAPROBE_FOLDER='" + folder.path() + "/texts' VLAPROBE_TOLD='" +
      folder.path() + "/told' VLAPROBE_FROM_EDITOR='" + folder.path() +
      "/from_editor' VLAPROBE_FROM_SERVER='" + folder.path() +
      "/from_server' VLAPROBE_PROGRAM='" VLAPROBE_BINARY_DIR "/vlaprobe' "
      "timeout 120 nvim --headless -u NONE -i NONE -n -c 'luafile " +
      kProtocol + "/neovim.lua' >nvim.log 2>&1";
  const int status = std::system(line.c_str());
  const std::string told = text_of_file(folder.path() + "/told");
  CAPTURE(told);
  CAPTURE(text_of_file(folder.path() + "/nvim.log"));
  CHECK(status == 0);
  for (const char* wanted :
       {"diagnostics: P0201", "code action: object other like ball { color blue }\n",
        "mended: yes\n", "hover: ", "highlight: 1\n", "references: 2\n", "symbols: 3\n",
        "workspace symbols: 1\n", "signature: distance(point, point)\n",
        "completion: ball other third\n", "lens: 0 tasks, 0 episodes vlaprobe.list\n", "foldingRange: ", "documentLink: 1\n",
        "semanticTokens/full: ", "semanticTokens/range: ", "inlayHint: ", "diagnostic: full ", "prepareRename: ball\n",
        "rename: object other like globe { color blue }\n",
        "formatting: object other like globe { color blue }\n",
        "definition: things.probe 3 object ball { color red; friction 1 }\n", "end: done\n"}) {
    CAPTURE(wanted);
    CHECK(told.find(wanted) != told.npos);
  }
  for (const char* mistake : {"NOTHING CAME", "FAILED", "ERROR"})
    CHECK(told.find(mistake) == told.npos);
  const std::string said = held(folder, "theirs");
  for (const char* method :
       {"codeAction", "codeLens", "completion", "definition", "documentHighlight", "documentLink",
        "documentSymbol", "foldingRange", "formatting", "hover", "references", "rename",
        "signatureHelp", "publishDiagnostics", "semanticTokens/full", "semanticTokens/range",
        "inlayHint", "diagnostic", "prepareRename"})
    CHECK_MESSAGE((said.empty() || said.find(std::string("textDocument/") + method) != said.npos),
                  method);
}

TEST_CASE("Emacs, set up as the page says, shows mistakes, hovers, completes, finds and renames") {
  // Debian's site files are where the package of eglot is found.
  const std::string emacs = "emacs --batch -q --eval '(progn (require (quote package)) (package-initialize))' ";
  if (!has("emacs") || std::system((emacs + "--eval \"(require 'eglot)\" >/dev/null 2>&1").c_str()) != 0) {
    MESSAGE("SKIPPED: emacs with eglot is not here");
    return;
  }
  const Folder folder;
  fs::create_directory(folder.path() + "/texts");
  folder.write("texts/things.probe", kThings);
  folder.write("texts/user.probe", "use \"things.probe\"\nobject other like bal { color blue }\n");
  const std::string line = "cd '" + folder.path() + "' && HOME='" + folder.path() +
                           "' VLAPROBE_FOLDER='" + folder.path() + "/texts' VLAPROBE_TOLD='" +
                           folder.path() + "/told' VLAPROBE_PROGRAM='" VLAPROBE_BINARY_DIR
                           "/vlaprobe' timeout 120 " + emacs + "-l '" + kProtocol +
                           "/eglot.el' >emacs.log 2>&1 </dev/null";
  const int status = std::system(line.c_str());
  const std::string told = text_of_file(folder.path() + "/told");
  CAPTURE(told);
  CAPTURE(text_of_file(folder.path() + "/emacs.log"));
  CHECK(status == 0);
  for (const char* wanted :
       {"server: vlaprobe\n", "[P0201]: unknown object `bal`\n", "hover: ```probe attribute color { red, blue } ```",
        "completion: ball\n", "mended: yes\n", "definition: object ball { color red; friction 1 }\n",
        "object other like globe { color blue }", "end: done\n"}) {
    CAPTURE(wanted);
    CHECK(told.find(wanted) != told.npos);
  }
  CHECK(told.find("FAILED") == told.npos);
}

TEST_CASE("what Neovim cannot ask is as the protocol has it, too") {
  const Folder folder;
  folder.write("things.probe", kThings);
  const std::string user = folder.write("user.probe", "");
  const Json all = {
      {"textDocument",
       {{"publishDiagnostics", {{"relatedInformation", true}}},
        {"diagnostic", Json::object()},
        {"documentSymbol", {{"hierarchicalDocumentSymbolSupport", true}}}}},
      {"workspace",
       {{"diagnostics", {{"refreshSupport", true}}},
        {"didChangeWatchedFiles", {{"dynamicRegistration", true}}}}}};
  Editor editor(folder.path(), std::chrono::milliseconds(1), all);
  const std::string suite = VLAPROBE_SOURCE_DIR "/suite/intact.probe", text = text_of_file(suite);
  const Json whole = {{"start", {{"line", 0}, {"character", 0}}},
                      {"end", {{"line", 60}, {"character", 0}}}};
  for (const auto& [path, shown] : {std::pair(suite, text), std::pair(user, kUser)}) {
    editor.open(path, shown);
    editor.change(path, place_of(shown, "use"), place_of(shown, "use"), "# added\n");
    editor.server().wait_checked(std::chrono::seconds(60));
    Json ranged = Editor::document(path);
    ranged["range"] = whole;
    editor.ask("textDocument/inlayHint", ranged);
    editor.ask("textDocument/semanticTokens/range", ranged);
    ranged["context"] = {{"diagnostics", Json::array()}};
    editor.ask("textDocument/codeAction", ranged);
    for (const char* method :
         {"textDocument/diagnostic", "textDocument/semanticTokens/full", "textDocument/codeLens",
          "textDocument/documentSymbol", "textDocument/foldingRange", "textDocument/documentLink"})
      editor.ask(method, Editor::document(path));
    for (const char* word : {"catalog", "things", "like ", "task", "color"}) {
      for (const char* method :
           {"textDocument/hover", "textDocument/prepareRename", "textDocument/completion",
            "textDocument/signatureHelp", "textDocument/definition",
            "textDocument/documentHighlight"})
        editor.ask(method, Editor::at(path, place_of("# added\n" + shown, word, 6)));
    }
  }
  editor.tell("textDocument/didClose", Editor::document(user));
  editor.ask("shutdown", Json());
  editor.tell("exit", Json());
  std::ofstream sent(folder.path() + "/from_editor"), got(folder.path() + "/from_server");
  for (const std::string& message : editor.sent()) sent << lsp::framed(message);
  for (const Json& message : editor.messages()) got << lsp::framed(message.dump());
  sent.close(), got.close();
  const std::string said = held(folder, "ours");
  for (const char* method :
       {"client/registerCapability", "initialize", "shutdown", "textDocument/diagnostic",
        "textDocument/inlayHint", "textDocument/prepareRename", "textDocument/semanticTokens/full",
        "textDocument/semanticTokens/range", "workspace/diagnostic/refresh"})
    CHECK_MESSAGE((said.empty() || said.find(method) != said.npos), method);
}
