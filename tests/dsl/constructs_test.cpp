// Every production of the grammar has a test that shows its meaning: the names of the cases of
// constructs_*_test.cpp begin with the productions they hold.
#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>
#include <string>

namespace fs = std::filesystem;

namespace {

std::string read(const fs::path& path) {
  std::ifstream stream(path, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

std::set<std::string> productions() {
  std::set<std::string> names;
  std::istringstream lines(read(fs::path(VLAPROBE_SOURCE_DIR) / "dsl/grammar.ebnf"));
  const std::regex head(R"(^([A-Za-z][A-Za-z0-9_]*)(\(X\))?\s+=\s.*)");
  std::smatch match;
  for (std::string line; std::getline(lines, line);) {
    if (std::regex_match(line, match, head)) names.insert(match[1]);
  }
  return names;
}

// "object, object_st: what it means"
std::set<std::string> tested() {
  std::set<std::string> names;
  const std::regex head(R"re(TEST_CASE\(\s*"([A-Za-z0-9_, ]+): )re");
  const std::regex word("[A-Za-z0-9_]+");
  for (const auto& entry : fs::directory_iterator(fs::path(VLAPROBE_SOURCE_DIR) / "tests/dsl")) {
    if (!entry.path().filename().string().starts_with("constructs_")) continue;
    const std::string text = read(entry.path());
    for (std::sregex_iterator at(text.begin(), text.end(), head), end; at != end; ++at) {
      const std::string list = (*at)[1];
      for (std::sregex_iterator name(list.begin(), list.end(), word); name != end; ++name)
        names.insert(name->str());
    }
  }
  return names;
}

}  // namespace

TEST_CASE("each production of the grammar has a test that names it, and each such name is one") {
  const std::set<std::string> wanted = productions(), found = tested();
  CHECK(wanted.size() > 60);
  for (const std::string& name : wanted) CHECK_MESSAGE(found.contains(name), name);
  for (const std::string& name : found) CHECK_MESSAGE(wanted.contains(name), name);
}
