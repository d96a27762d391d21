// A moment of the campaign over mutated plans: tests/campaigns/README.md.
#include <doctest/doctest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

namespace {

TEST_CASE("of two hundred mutated plans each is refused by a rule, or runs twice alike") {
  const std::string source = VLAPROBE_SOURCE_DIR;
  const std::filesystem::path said = "campaign_plans.txt";
  std::string command = "'" VLAPROBE_BINARY_DIR "/tests/campaigns/campaign_plans'";
  for (const char* text : {"worn_cell", "put_away", "joint_arm", "moving"})
    command += " '" + source + "/examples/" + text + ".probe'";
  const int status = std::system((command + " --count 200 >" + said.string() + " 2>&1").c_str());
  std::ifstream in(said);
  std::stringstream text;
  text << in.rdbuf();
  CHECK_MESSAGE(status == 0, text.str());
  CHECK_MESSAGE(text.str().find("200 plans, seeds 1 to 201, ") != std::string::npos, text.str());
  CHECK_MESSAGE(text.str().find(" 0 ran twice alike") == std::string::npos, text.str());
}

}  // namespace
