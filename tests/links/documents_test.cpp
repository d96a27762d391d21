// What documents name of the tree is there.
#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>
#include <string>

namespace {

namespace fs = std::filesystem;
const fs::path kTree = VLAPROBE_SOURCE_DIR;

TEST_CASE("every file and folder that CONTRIBUTING.md names is there") {
  std::ifstream file(kTree / "CONTRIBUTING.md");
  std::ostringstream read;
  read << file.rdbuf();
  const std::string text = read.str();
  static const std::regex kPath(R"(`((compiler|runtime|dsl|suite|assets|tests|examples)/[\w./-]+|[A-Z]+\.md)`)");
  int named = 0;
  for (std::sregex_iterator at(text.begin(), text.end(), kPath), end; at != end; ++at) {
    ++named;
    CHECK_MESSAGE(fs::exists(kTree / (*at)[1].str()), (*at)[1].str(), " is not there");
  }
  CHECK(named > 30);
}

}  // namespace
