// Scripts by which shells complete the program's words, from what its help says.
#pragma once

#include <string>

#include "runtime/cli/arguments.h"

namespace probe::cli {

// To be read by `source <(vlaprobe completion bash)`.
std::string bash_completion(const VerbText& program);
// A `_vlaprobe` of zsh's $fpath.
std::string zsh_completion(const VerbText& program);
// A vlaprobe.fish of fish's completions.
std::string fish_completion(const VerbText& program);

}  // namespace probe::cli
