// And of what shows that it would find a mistake.
#include <doctest/doctest.h>

#include "tests/shell_program.h"

namespace {

probe::test::ShellOutcome cut(const std::string& words) {
  return probe::test::run_shell("/usr/bin/python3 '" VLAPROBE_SOURCE_DIR
                                "/tests/campaigns/power_cut.py' --build '" VLAPROBE_BINARY_DIR
                                "' " +
                                words);
}

}  // namespace

TEST_CASE("when the power is cut nothing that was stored is lost or torn, and the verb goes on") {
  const auto [status, said] = cut("--cuts 6 run merge");
  CHECK_MESSAGE(status == 0, said);
  CHECK_MESSAGE(said.find("run: 6 cuts") != said.npos, said);
  CHECK_MESSAGE(said.find("merge: 6 cuts") != said.npos, said);
}

TEST_CASE("traces that are not forced to the disk would be found") {
  const auto [status, said] = cut("--cuts 40 --forget .trace run");
  CHECK_MESSAGE(status == 0, said);
  CHECK_MESSAGE(said.find("is left out") != said.npos, said);
}
