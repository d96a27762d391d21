// Compiling for the verbs: runs the compiler and prints its diagnostics in the way the user asked
// for.
#pragma once

#include <string>
#include <vector>

#include "runtime/cli/verbs.h"

namespace probe::cli {

struct CompiledText {
  std::vector<std::byte> plan;  // empty unless asked for
  std::size_t errors = 0, warnings = 0;
  int exit = kFine;  // kUser when there were errors
};

// Diagnostics go to stderr as text, or to stdout as JSON with `json`.
CompiledText compile_text(const std::vector<std::string>& files, const AssetOptions& assets,
                          const std::string& suite, bool want_plan, bool json = false);

}  // namespace probe::cli
