// examples/ci: what GitHub and GitLab take, by their own schemas; and each call of the program in
// them, which has to be understood.
#include <doctest/doctest.h>

#include <array>
#include <cstdio>
#include <sstream>

#include "tests/node_program.h"

namespace {

std::string output_of(const std::string& command) {
  std::string text;
  FILE* const pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) return text;
  for (std::array<char, 4096> part; std::size_t n = fread(part.data(), 1, part.size(), pipe);)
    text.append(part.data(), n);
  pclose(pipe);
  return text;
}

TEST_CASE("examples/ci fits its systems' schemas, and what it calls there is") {
  const probe::test::ShellOutcome said = probe::test::run_node(
      "tests/outside/check_ci.mjs", "'" VLAPROBE_BINARY_DIR "/outside/node_modules' ci");
  REQUIRE_MESSAGE(said.status == 0, said.words);
  std::istringstream lines(said.words);
  int calls = 0;
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with("vlaprobe ")) continue;
    ++calls;
    std::istringstream words(line);
    std::string program, verb;
    words >> program >> verb;
    const std::string help = output_of("'" VLAPROBE_BINARY_DIR "/vlaprobe' " + verb + " --help");
    CHECK_MESSAGE(help.find("Options:") != std::string::npos, line);
    for (std::string word; words >> word;) {
      if (word.starts_with("--")) CHECK_MESSAGE(help.find(word) != std::string::npos, line);
    }
  }
  CHECK(calls >= 8);
}

}  // namespace
