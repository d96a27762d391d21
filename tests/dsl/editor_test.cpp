#include <doctest/doctest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>

#include "dsl/editor/textmate.h"
#include "runtime/base/json.h"

using namespace probe;

namespace {

const std::filesystem::path kExtension =
    std::filesystem::path(VLAPROBE_SOURCE_DIR) / "dsl/editor/vscode";

std::string read(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

}  // namespace

TEST_CASE("the editor's grammar is the one that the tables of words and units give") {
  const std::filesystem::path path = kExtension / "syntaxes/probe.tmLanguage.json";
  const std::string wanted = editor::textmate_grammar();
  if (std::getenv("VLAPROBE_UPDATE_GOLDEN") != nullptr) {
    std::ofstream(path, std::ios::binary) << wanted;
  }
  CHECK_MESSAGE(read(path) == wanted, "tests/golden/run --update rewrites it");
}

TEST_CASE("numbers match with their longest unit") {
  const auto grammar = Json::parse(editor::textmate_grammar());
  std::string pattern = grammar["repository"]["numbers"]["patterns"][0]["match"].text();
  pattern.erase(0, pattern.find(')') + 1);  // without what stands before it
  const std::regex number(pattern);
  std::smatch match;
  for (const std::string& text : {std::string("700kg/m3"), std::string("152.12Nms/rad"),
                                  std::string("1e-6Ns"), std::string("20.6cm")}) {
    CHECK_MESSAGE(std::regex_match(text, match, number), text);
  }
  CHECK(!std::regex_match("2x", number));
}

TEST_CASE("the extension's parts are there and refer to one another") {
  const auto package = Json::parse(read(kExtension / "package.json"));
  const auto& contributes = package["contributes"];
  for (const std::string& path : {contributes["languages"][0]["configuration"].get<std::string>(),
                                  contributes["grammars"][0]["path"].get<std::string>()}) {
    CHECK_MESSAGE(!Json::parse(read(kExtension / path)).is_discarded(), path);
  }
  CHECK(contributes["grammars"][0]["scopeName"] == "source.probe");
}

TEST_CASE("the extension is packed by a command, unpacks whole with its licences, and talks to the server") {
  const auto run = [](const std::string& line) { return std::system(line.c_str()); };
  if (run("node -e 'process.exit(parseInt(process.versions.node) < 20 ? 1 : 0)'") != 0) {
    MESSAGE("SKIPPED: the extension is not packed, node is older than 20");
    return;
  }
  const std::filesystem::path packages = std::filesystem::path(VLAPROBE_BINARY_DIR) / "vscode";
  const std::filesystem::path made = packages / "tested", unpacked = made / "unpacked/extension";
  std::filesystem::remove_all(made);
  const std::string log = (made / "log").string();
  std::filesystem::create_directories(made);
  const auto told = [&](const std::string& line) {
    CHECK_MESSAGE(run("timeout 120 " + line + " >'" + log + "' 2>&1") == 0, read(log));
    return read(log);
  };
  const std::string vsix = (made / "probe-language.vsix").string();
  told("node '" + (kExtension / "build.mjs").string() + "' '" + packages.string() + "' '" + vsix + "'");
  told("python3 -m zipfile -e '" + vsix + "' '" + (made / "unpacked").string() + "'");
  const std::string notices = read(unpacked / "THIRD_PARTY_LICENSES.txt");
  for (const char* package : {"vscode-languageclient 11.0.0", "vscode-jsonrpc ",
                              "vscode-languageserver-protocol ", "semver ", "minimatch "})
    CHECK_MESSAGE(notices.find(package) != notices.npos, package);
  // The grammar inside is the one that is tested above.
  CHECK(read(unpacked / "syntaxes/probe.tmLanguage.json") ==
        read(kExtension / "syntaxes/probe.tmLanguage.json"));

  const auto driven = [&](const std::string& program) {
    return told("node '" + (kExtension / "drive.test.mjs").string() + "' '" + unpacked.string() +
                "' '" + program + "' '" + (made / "texts").string() + "'");
  };
  const std::string said = driven(VLAPROBE_BINARY_DIR "/vlaprobe");
  for (const char* wanted :
       {"registered: vlaprobe.list vlaprobe.preview vlaprobe.restart vlaprobe.runExpert vlaprobe.show; said: nothing",
        "diagnostics: P0201 1:18 unknown object `bal`", "hover: ```probe object ball", "completion: ball other",
        "mended: yes", "lens: 1 saved, .: vlaprobe list ./user.probe --suite mine", "end: done"})
    CHECK_MESSAGE(said.find(wanted) != said.npos, wanted, " in ", said);
  const std::string absent = driven("/no/such/vlaprobe");
  CHECK_MESSAGE(absent.find("vlaprobe could not be started") != absent.npos, absent);
}
