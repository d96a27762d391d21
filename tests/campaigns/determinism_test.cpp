#include <doctest/doctest.h>

#include "tests/shell_program.h"

TEST_CASE("traces, pictures and verdicts do not depend on what surrounds a run") {
  const auto [status, said] = probe::test::run_shell(
      "bash '" VLAPROBE_SOURCE_DIR "/tests/campaigns/determinism.sh' 1 '" VLAPROBE_BINARY_DIR
      "/vlaprobe'");
  CHECK_MESSAGE(status == 0, said);
  CHECK_MESSAGE(said.find("13 of 13 runs") != said.npos, said);
}
