#include <doctest/doctest.h>

#include "tests/shell_program.h"

TEST_CASE("damaged files of every kind that is read are taken or refused with a reason") {
  const auto [status, said] = probe::test::run_shell(
      "'" VLAPROBE_BINARY_DIR "/tests/campaigns/campaign_readers' --count 1600");
  CHECK_MESSAGE(status == 0, said);
  CHECK_MESSAGE(said.find("1600 seeds from 1 on, ") != said.npos, said);
  // Some of each kind are harmless.
  CHECK_MESSAGE(said.find(" 0 taken") == said.npos, said);
}
