// A moment of the campaign that cuts the power, and of what shows that it would find a mistake:
// tests/campaigns/README.md.
#include <doctest/doctest.h>

#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>

namespace {

// What it said, and whether it ended with 0.
std::pair<bool, std::string> campaign(const std::string& words) {
  const std::string command = "/usr/bin/python3 '" VLAPROBE_SOURCE_DIR
                              "/tests/campaigns/power_cut.py' --build '" VLAPROBE_BINARY_DIR "' " +
                              words + " >power_cut.txt 2>&1";
  const int status = std::system(command.c_str());
  std::ifstream in("power_cut.txt");
  std::stringstream text;
  text << in.rdbuf();
  return {status == 0, text.str()};
}

}  // namespace

TEST_CASE("when the power is cut nothing that was stored is lost or torn, and the verb goes on") {
  const auto [fine, said] = campaign("--cuts 6 run merge");
  CHECK_MESSAGE(fine, said);
  CHECK_MESSAGE(said.find("run: 6 cuts") != said.npos, said);
  CHECK_MESSAGE(said.find("merge: 6 cuts") != said.npos, said);
}

TEST_CASE("traces that are not forced to the disk would be found") {
  const auto [fine, said] = campaign("--cuts 40 --forget .trace run");
  CHECK_MESSAGE(fine, said);
  CHECK_MESSAGE(said.find("is left out") != said.npos, said);
}
