#include <doctest/doctest.h>

#include "tests/campaigns/campaign.h"

TEST_CASE(
    "whatever a policy asks for, worlds stay finite, nothing is thrown or pushed through the "
    "table") {
  const auto [fine, said] =
      probe::test::campaign("'" VLAPROBE_BINARY_DIR
                            "/tests/campaigns/campaign_policies' --count 120 '" VLAPROBE_SOURCE_DIR
                            "/suite/intact.probe' '" VLAPROBE_SOURCE_DIR "/suite/kitchen.probe'");
  CHECK_MESSAGE(fine, said);
  CHECK_MESSAGE(said.find("120 seeds from 1 on, ") != said.npos, said);
}
