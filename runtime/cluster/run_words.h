// `vlaprobe run` as words, for a job that calls it elsewhere.
#pragma once

#include <string>
#include <vector>

#include "runtime/run/run.h"

namespace probe::cluster {

// For what the options choose, but plan, policy, name, folder, jobs and shard.
std::vector<std::string> run_words(const run::RunOptions& options);

}  // namespace probe::cluster
