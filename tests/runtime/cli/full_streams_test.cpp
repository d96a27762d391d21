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

TEST_CASE("a file that may not grow is a failure with its place, and the run goes on afterwards") {
  const Sandbox box;
  const std::string run = "'" VLAPROBE_BINARY_DIR
                          "/vlaprobe' run \"$SUITE\" --tasks carrot_on_plate --episodes 0-0 "
                          "--policy null -o limited";
  const Outcome limited = box.run("ulimit -f 64; " + run);  // of 512 bytes
  CHECK(limited.exit == 2);
  CHECK_MESSAGE(contains(limited.err, "vlaprobe: "), limited.err);
  const Outcome whole = box.run(run);
  CHECK_MESSAGE(whole.exit == 0, whole.err);
}

}  // namespace probe::test
