#include "tests/campaigns/check_campaign.h"

using namespace probe::test;

TEST_CASE("of two hundred mutated plans each is refused by a rule, or runs twice alike") {
  std::string command = "'" VLAPROBE_BINARY_DIR "/tests/campaigns/campaign_plans' --count 200";
  for (const char* text : {"worn_cell", "put_away", "joint_arm", "moving"})
    command += " '" VLAPROBE_SOURCE_DIR "/examples/" + std::string(text) + ".probe'";
  const std::string said = check_campaign(command, {"200 seeds from 1 on, "});
  CHECK_MESSAGE(said.find(" 0 ran twice alike") == said.npos, said);
}
