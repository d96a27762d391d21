#include "tests/campaigns/check_campaign.h"

using namespace probe::test;

TEST_CASE(
    "whatever a policy asks for, worlds stay finite, nothing is thrown or pushed through the "
    "table") {
  check_campaign("'" VLAPROBE_BINARY_DIR
                 "/tests/campaigns/campaign_policies' --count 120 '" VLAPROBE_SOURCE_DIR
                 "/suite/intact.probe' '" VLAPROBE_SOURCE_DIR "/suite/kitchen.probe'",
                 {"120 seeds from 1 on, "});
}
