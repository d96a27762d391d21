#include <doctest/doctest.h>

#include "tests/shell_program.h"

TEST_CASE(
    "whatever a policy asks for, worlds stay finite, nothing is thrown or pushed through the "
    "table") {
  const auto [status, said] =
      probe::test::run_shell("'" VLAPROBE_BINARY_DIR
                             "/tests/campaigns/campaign_policies' --count 120 '" VLAPROBE_SOURCE_DIR
                             "/suite/intact.probe' '" VLAPROBE_SOURCE_DIR "/suite/kitchen.probe'");
  CHECK_MESSAGE(status == 0, said);
  CHECK_MESSAGE(said.find("120 seeds from 1 on, ") != said.npos, said);
}
