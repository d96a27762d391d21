#include "tests/campaigns/check_campaign.h"

using namespace probe;

TEST_CASE("an asking that is killed asks the rest, and has the answers of one that nobody killed") {
  test::check_campaign(
      "ASK_WORDS='--questions understanding.source --tasks *carrot_on_plate' bash "
      "'" VLAPROBE_SOURCE_DIR "/tests/campaigns/ask_kills.sh' 3 '" VLAPROBE_BINARY_DIR "/vlaprobe'",
      {"equal to the undisturbed call"});
}
