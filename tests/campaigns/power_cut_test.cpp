// And of what shows that it would find a mistake.
#include "tests/campaigns/check_campaign.h"

using namespace probe::test;

namespace {

std::string cut(const std::string& words) {
  return "/usr/bin/python3 '" VLAPROBE_SOURCE_DIR
         "/tests/campaigns/power_cut.py' --build '" VLAPROBE_BINARY_DIR "' " +
         words;
}

}  // namespace

TEST_CASE("when the power is cut nothing that was stored is lost or torn, and the verb goes on") {
  check_campaign(
      cut("--cuts 4 run merge sweep table dataset"),
      {"run: 4 cuts", "merge: 4 cuts", "sweep: 4 cuts", "table: 4 cuts", "dataset: 4 cuts"});
}

TEST_CASE("traces that are not forced to the disk would be found") {
  check_campaign(cut("--cuts 40 --forget .trace run"), {"is left out"});
}
