#include <doctest/doctest.h>

#include "tests/campaigns/campaign.h"

TEST_CASE("traces, pictures and verdicts do not depend on what surrounds a run") {
  const auto [fine, said] = probe::test::campaign(
      "bash '" VLAPROBE_SOURCE_DIR "/tests/campaigns/determinism.sh' 1 '" VLAPROBE_BINARY_DIR
      "/vlaprobe'");
  CHECK_MESSAGE(fine, said);
  CHECK_MESSAGE(said.find("13 of 13 runs") != said.npos, said);
}
