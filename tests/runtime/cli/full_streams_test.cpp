// Streams that take no more: a full disk behind a log or a redirection.
#include <doctest/doctest.h>

#include "tests/runtime/cli/program.h"

namespace probe::test {

TEST_CASE("a log that takes no more words changes no exit code and ends no verb") {
  const Sandbox box;
  write_file(box / "wrong.probe", "task {\n");
  // `$?` of the verb goes to the file that the sandbox shows as its output.
  for (const auto& [words, exit] :
       {std::pair("check absent.probe", "2"), std::pair("check wrong.probe", "1"),
        std::pair("check \"$SUITE\"", "0"), std::pair("build \"$SUITE\" -o g.plan", "0"),
        std::pair("nonsense", "1"), std::pair("run g.plan --no-such-flag", "1")}) {
    CAPTURE(words);
    const Outcome outcome = box.vlaprobe(std::string(words) + " >/dev/null 2>/dev/full; echo $?");
    CHECK(outcome.out == std::string(exit) + "\n");
  }
  CHECK(std::filesystem::exists(box / "g.plan"));
}

TEST_CASE("data that cannot be written is a failure with its place") {
  const Sandbox box;
  const Outcome outcome =
      box.vlaprobe("list \"$SUITE\" >/dev/full 2>told; echo $? >>told; cat told");
  CHECK(outcome.out.ends_with("\n2\n"));
  CHECK(contains(outcome.out, "standard output"));
}

}  // namespace probe::test
