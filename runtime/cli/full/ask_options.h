// The options of the verbs that put questions to a model, and what they read in common.
#pragma once

#include <string>
#include <vector>

#include "runtime/ask/ask.h"
#include "runtime/cli/full/run_options.h"

namespace probe::cli {

struct AskArguments {
  RunArguments run;  // file, out, name, suite, tasks, episodes, if_changed, jobs, retries, ...
  std::string model, frames, shard = "1/1";
  std::vector<std::string> questions, arms = {"picture"};
  bool json = false;
};

void add_ask_options(Verb verb, AskArguments& arguments);
// Of these the help has no words of their own.
inline constexpr const char* kMoreAskOptions =
    "more, in runtime/ask/README.md: --name --suite --retries --give-up-after --insecure "
    "--if-changed --assets --std\n";

// All but progress.
Result<ask::AskOptions> ask_options(const AskArguments& arguments);

// The plan, or the exit code to leave with after the reason was printed; completes `options`.
LoadedPlan load_asked(const AskArguments& arguments, ask::AskOptions& options);

}  // namespace probe::cli
