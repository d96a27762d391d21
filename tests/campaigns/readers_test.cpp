#include "tests/campaigns/check_campaign.h"

using namespace probe::test;

// As many as make each of the kinds whole once.
TEST_CASE(
    "damaged files and messages of every kind that is read are taken or refused with a reason") {
  const std::string said =
      check_campaign("'" VLAPROBE_BINARY_DIR "/tests/campaigns/campaign_readers' --count 800",
                     {"800 seeds from 1 on, ", "\nrobomimic ", "\nquestions ", "\ngrpc "});
  // Some of each kind are harmless.
  CHECK_MESSAGE(said.find(" 0 taken") == said.npos, said);
}
