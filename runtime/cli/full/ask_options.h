// The options of the verbs that put questions to a model, and what they read in common.
#pragma once

#include <string>
#include <vector>

#include "runtime/ask/ask.h"
#include "runtime/cli/full/run_options.h"

namespace probe::cli {

struct AskArguments : SharedArguments {
  std::string model, frames, shard = "1/1";
  std::vector<std::string> questions, arms = {"picture"};
  bool json = false;
};

// In the words of `ask`, or of `slurm-ask`, whose help leaves out what `ask --help` has.
void add_ask_options(Verb verb, AskArguments& arguments, SharedWords words);
// A line or two that name the options of which that help has no words.
std::string more_ask_options(SharedWords words);

// All but progress.
Result<ask::AskOptions> ask_options(const AskArguments& arguments);

// The plan, or the exit code to leave with after the reason was printed; completes `options`.
LoadedPlan load_asked(const AskArguments& arguments, ask::AskOptions& options);

}  // namespace probe::cli
