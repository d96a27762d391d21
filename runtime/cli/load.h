// What the verbs take as F: a .plan file, opened and verified, or .probe text, compiled in memory
// with its diagnostics printed.
#pragma once

#include <optional>
#include <string>

#include "compiler/emit/compile.h"
#include "runtime/cli/verbs.h"
#include "runtime/plan/plan.h"

namespace probe::cli {

// The plan, or the exit code to leave with after the reason was printed.
struct LoadedPlan {
  std::optional<plan::Plan> plan;
  int exit = kFine;
  AssetRoot assets;                         // where its files lie; empty: found by itself
  bool is_text = false;                     // compiled just now
  std::vector<ReferringWords> referring;    // of a text
  std::vector<std::string> unused_phrases;  // of a text: "object.phrase" that no task refers by
  std::vector<std::string> files;           // the plan, or every text and table that was read
  bool only_used_suites = false;  // a text that declares no suite, while files that it uses do
};
LoadedPlan load_plan(const std::string& path, const AssetOptions& assets,
                     const std::string& suite = {});

// Whether `out` may be written with what is made of it: assets::check_output with all that was
// read, models and their pictures too. Fails as that.
Status check_output(const std::string& out, const LoadedPlan& loaded);

// Indices by name; on an unknown one prints it with the nearest spelling and sets `exit`.
std::optional<std::uint32_t> find_task(const plan::Plan& plan, const std::string& name, int& exit);
std::optional<std::uint32_t> find_suite(const plan::Plan& plan, const std::string& name, int& exit);
// The members of the suite of that name, or all tasks when `suite` is empty.
std::optional<std::vector<std::uint32_t>> select_tasks(const plan::Plan& plan,
                                                       const std::string& suite, int& exit);

}  // namespace probe::cli
