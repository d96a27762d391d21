#include <doctest/doctest.h>

#include "tests/shell_program.h"

TEST_CASE("of two hundred mutated plans each is refused by a rule, or runs twice alike") {
  std::string words = "'" VLAPROBE_BINARY_DIR "/tests/campaigns/campaign_plans' --count 200";
  for (const char* text : {"worn_cell", "put_away", "joint_arm", "moving"})
    words += " '" VLAPROBE_SOURCE_DIR "/examples/" + std::string(text) + ".probe'";
  const auto [status, said] = probe::test::run_shell(words);
  CHECK_MESSAGE(status == 0, said);
  CHECK_MESSAGE(said.find("200 seeds from 1 on, ") != said.npos, said);
  CHECK_MESSAGE(said.find(" 0 ran twice alike") == said.npos, said);
}
