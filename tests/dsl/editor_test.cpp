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

TEST_CASE("the packed extension is whole, with its licences, and registers what lenses name") {
  const std::filesystem::path made = std::filesystem::path(VLAPROBE_BINARY_DIR) / "vscode";
  if (!std::filesystem::exists(made / "probe-language.vsix")) {
    MESSAGE("SKIPPED: build/vscode/probe-language.vsix is not here (ninja vscode_extension)");
    return;
  }
  const std::string notices = read(made / "stage/THIRD_PARTY_LICENSES.txt");
  for (const char* package : {"vscode-languageclient 11.0.0", "vscode-jsonrpc ",
                              "vscode-languageserver-protocol ", "semver ", "minimatch "})
    CHECK_MESSAGE(notices.find(package) != notices.npos, package);
  // The grammar inside is the one that is tested above.
  CHECK(read(made / "stage/syntaxes/probe.tmLanguage.json") ==
        read(kExtension / "syntaxes/probe.tmLanguage.json"));
  const auto loaded = [&](const std::string& program) {
    const std::string told = (made / "loaded.txt").string();
    const std::string line = "timeout 60 node '" + (kExtension / "load.test.mjs").string() + "' '" +
                             (made / "stage").string() + "' '" + program + "' >'" + told + "' 2>&1";
    CHECK(std::system(line.c_str()) == 0);
    return read(told);
  };
  const std::string absent = loaded("/no/such/vlaprobe");
  CHECK_MESSAGE(absent.find("registered 5; said: ") != absent.npos, absent);
  CHECK_MESSAGE(absent.find("vlaprobe could not be started") != absent.npos, absent);
}
