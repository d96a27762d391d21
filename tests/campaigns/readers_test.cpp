#include <doctest/doctest.h>

#include "tests/campaigns/campaign.h"

TEST_CASE("damaged files of every kind that is read are taken or refused with a reason") {
  const auto [fine, said] = probe::test::campaign(
      "'" VLAPROBE_BINARY_DIR "/tests/campaigns/campaign_readers' --count 1600");
  CHECK_MESSAGE(fine, said);
  CHECK_MESSAGE(said.find("1600 seeds from 1 on, ") != said.npos, said);
  // Some of each kind are harmless.
  CHECK_MESSAGE(said.find(" 0 taken") == said.npos, said);
}
