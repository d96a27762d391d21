#include <doctest/doctest.h>

#include "tests/shell_program.h"

TEST_CASE("what lacks handles, memory, room or time says so, and goes on where it does not") {
  const auto [status, said] = probe::test::run_shell(
      "bash '" VLAPROBE_SOURCE_DIR "/tests/campaigns/scarce.sh' 1 '" VLAPROBE_BINARY_DIR
      "/vlaprobe'");
  CHECK_MESSAGE(status == 0, said);
  CHECK_MESSAGE(said.find(" 0 findings") != said.npos, said);
}
