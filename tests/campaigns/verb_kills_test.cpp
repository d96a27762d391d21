#include "tests/campaigns/check_campaign.h"

using namespace probe;

TEST_CASE("a verb that is killed leaves nothing half, and comes to what it would have come to") {
  test::check_campaign("bash '" VLAPROBE_SOURCE_DIR
                       "/tests/campaigns/verb_kills.sh' 5 '" VLAPROBE_BINARY_DIR "/vlaprobe'",
                       {"every output is that of a calm one"});
}
