// The options that all verbs have which evaluate a policy, and what they read and say in common.
#pragma once

#include <optional>
#include <string>
#include <utility>

#include "runtime/cli/full/shared_options.h"
#include "runtime/cli/load.h"
#include "runtime/cli/verbs.h"
#include "runtime/run/run.h"

namespace probe::cli {

struct RunArguments : SharedArguments {
  std::string policy, seeds, video = "none", live_delay;
  bool live = false;
  std::optional<int> live_most_held;  // %
};

void add_run_options(Verb verb, RunArguments& arguments);

// All but shard and progress.
Result<run::RunOptions> to_options(const RunArguments& arguments);

// The plan to run, or the exit code to leave with after the reason was printed.
LoadedPlan load_runnable(const RunArguments& arguments);

// The suites of a file that is only used are not what the user asked for.
Failure no_own_suite(const plan::Plan& plan, const std::string& file);

// Of a server whose certificate is not looked at, before it is asked.
void warn_of_insecure(const std::string& policy);

// "invalid: TASK episode E seed S: why" on its own line.
void print_invalid(const store::ResultRow& row);
// Notes, counts and speed of a call, for stderr.
void print_summary(const run::RunSummary& summary);

// "A-B" or "A", and "I/N". Fail (kUsage) on other texts.
Result<std::pair<int, int>> parse_range(const std::string& text);
Result<std::pair<int, int>> parse_shard(const std::string& text);
// Of --name. Fails (kUsage) on what could repaint a terminal.
Status check_name(const std::string& name);
// Of one of the words of --if-changed.
run::IfChanged if_changed_of(const std::string& word);

// A whole number and nothing else.
std::optional<int> to_int(std::string_view text);

}  // namespace probe::cli
