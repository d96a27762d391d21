// A campaign of a moment: what its tests have in common.
#pragma once

#include <doctest/doctest.h>

#include <initializer_list>
#include <string>

#include "tests/shell_program.h"

namespace probe::test {

// One of the scripts here, for one round: words of a shell.
inline std::string one_round_of(const std::string& script) {
  return "bash '" VLAPROBE_SOURCE_DIR "/tests/campaigns/" + script +
         "' 1 '" VLAPROBE_BINARY_DIR "/vlaprobe'";
}

// Runs it. It ends with 0 and says all of this; returns what it said.
inline std::string check_campaign(const std::string& command,
                                  std::initializer_list<const char*> says) {
  const auto [status, said] = run_shell(command);
  CHECK_MESSAGE(status == 0, said);
  for (const char* const part : says) CHECK_MESSAGE(said.find(part) != said.npos, said);
  return said;
}

}  // namespace probe::test
