#include "tests/campaigns/check_campaign.h"

using namespace probe::test;

TEST_CASE("damaged files of every kind that is read are taken or refused with a reason") {
  const std::string said =
      check_campaign("'" VLAPROBE_BINARY_DIR "/tests/campaigns/campaign_readers' --count 1600",
                     {"1600 seeds from 1 on, "});
  // Some of each kind are harmless.
  CHECK_MESSAGE(said.find(" 0 taken") == said.npos, said);
}
