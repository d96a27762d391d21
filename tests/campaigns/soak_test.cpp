#include "tests/campaigns/check_campaign.h"

using namespace probe;

TEST_CASE("a run that goes on and on keeps its memory and its files") {
  test::check_campaign("folder=$(mktemp -d); bash '" VLAPROBE_SOURCE_DIR
                       "/tests/campaigns/soak.sh' 15s \"$folder\" '" VLAPROBE_BINARY_DIR
                       "/vlaprobe'; status=$?; rm -rf \"$folder\"; exit $status",
                       {" 0 invalid: "});
}
