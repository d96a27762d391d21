#include <doctest/doctest.h>

#include <cstdlib>

#include "tests/runtime/cli/program.h"

namespace probe::test {
namespace {

bool has(const char* program) {
  return std::system((std::string("command -v ") + program + " >/dev/null 2>&1").c_str()) == 0;
}

// What bash offers for the last of the words.
std::string offered(const Sandbox& box, const std::string& words) {
  write_file(box / "ask.sh", R"(source ./words.bash
COMP_WORDS=("$@")
COMP_CWORD=$(($# - 1))
_vlaprobe
echo "${COMPREPLY[*]}"
)");
  const Outcome outcome = box.run("bash ask.sh " + words);
  CHECK(outcome.err == "");
  return outcome.out;
}

TEST_CASE("bash completes verbs, verbs of verbs, options and what options take") {
  Sandbox box;
  write_file(box / "words.bash", box.vlaprobe("completion bash").out);
  CHECK(offered(box, "vlaprobe che") == "check\n");
  CHECK(offered(box, "vlaprobe assets impo") == "import\n");
  CHECK(offered(box, "vlaprobe run --epis") == "--episodes\n");
  CHECK(offered(box, "vlaprobe assets import --fi") == "--fill\n");
  CHECK(offered(box, "vlaprobe run --video ''") == "none failures all\n");
}

TEST_CASE("bash is left to complete files where a file is wanted") {
  Sandbox box;
  write_file(box / "words.bash", box.vlaprobe("completion bash").out);
  CHECK(offered(box, "vlaprobe run ''") == "\n");
  CHECK(offered(box, "vlaprobe run --out ''") == "\n");
}

TEST_CASE("scripts of zsh and fish are read by them") {
  Sandbox box;
  for (const std::string shell : {"zsh", "fish"}) {
    const Outcome script = box.vlaprobe("completion " + shell);
    CHECK(script.exit == 0);
    for (const char* word : {"check", "episodes", "failures"})
      CHECK(script.out.find(word) != std::string::npos);
    if (!has(shell.c_str())) {
      MESSAGE("SKIPPED: " << shell << " is not installed, so it has not read its script");
      continue;
    }
    write_file(box / "script", script.out);
    CHECK(box.run(shell + " -n script").exit == 0);
  }
}

TEST_CASE("a shell that is not known is refused by name") {
  Sandbox box;
  const Outcome outcome = box.vlaprobe("completion csh");
  CHECK(outcome.exit == 1);
  CHECK(outcome.err.find("csh") != std::string::npos);
}

TEST_CASE("the manual page has every verb of the help and is good roff") {
  Sandbox box;
  const Outcome page = box.vlaprobe("manual");
  REQUIRE(page.exit == 0);
  for (const char* verb : {"check", "run", "assets import", "completion"})
    CHECK(page.out.find(std::string(".SS \"vlaprobe ") + verb + "\"") != std::string::npos);
  CHECK(page.out.find("\\fB\\-\\-episodes") != std::string::npos);
  if (!has("groff")) {
    MESSAGE("SKIPPED: groff is not installed, so the page was not set");
    return;
  }
  write_file(box / "page", page.out);
  const Outcome set = box.run("groff -man -ww -z page");
  CHECK(set.exit == 0);
  CHECK(set.err == "");
}

TEST_CASE("the table of verbs in the README of the command line is that of the program") {
  Sandbox box;
  const Outcome table = box.vlaprobe("manual --verbs");
  REQUIRE(table.exit == 0);
  CHECK(table.out.find("| `assets import` |") != std::string::npos);
  const std::string readme = read_file(VLAPROBE_SOURCE_DIR "/runtime/cli/README.md");
  CHECK_MESSAGE(readme.find(table.out) != std::string::npos,
                "put this in the place of the table there:\n", table.out);
}

}  // namespace
}  // namespace probe::test
