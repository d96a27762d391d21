// The options that all verbs have which fill a folder, of episodes or of answers, in one table:
// what they take, and what the help of each calls them.
#pragma once

#include <string>

#include "runtime/cli/verbs.h"

namespace probe::cli {

struct SharedArguments {
  std::string file, name, out, suite, tasks = "*", episodes, if_changed = "refuse";
  int jobs = 1, retries = 2, give_up_after = 5;
  bool insecure = false;
  AssetOptions assets;
};

// Whose words the help has. What has none there works and is named by `unsaid_options`.
enum class SharedWords { kRun, kAsk, kSlurmAsk };

void add_shared_options(Verb verb, SharedArguments& arguments, SharedWords words);

// "--name --suite ...", without words of their own in that help.
std::string unsaid_options(SharedWords words);

}  // namespace probe::cli
