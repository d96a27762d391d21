#include <doctest/doctest.h>

#include "tests/shell_program.h"

TEST_CASE("a verb that is killed leaves nothing half, and comes to what it would have come to") {
  const auto [status, said] = probe::test::run_shell(
      "bash '" VLAPROBE_SOURCE_DIR "/tests/campaigns/verb_kills.sh' 5 '" VLAPROBE_BINARY_DIR
      "/vlaprobe'");
  CHECK_MESSAGE(status == 0, said);
  CHECK_MESSAGE(said.find("every output is that of a calm one") != said.npos, said);
}
