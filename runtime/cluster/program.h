// Another program, run to its end without a shell.
#pragma once

#include <string>
#include <vector>

#include "runtime/base/result.h"

namespace probe::cluster {

struct ProgramOutput {
  int status = 0;  // exit code; 128 + signal when it was killed
  std::string out, err;
};

// Looks `words[0]` up in PATH. Fails (kIo, where = its name) when it cannot be started.
Result<ProgramOutput> run_program(const std::vector<std::string>& words);

}  // namespace probe::cluster
