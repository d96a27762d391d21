// Compiling for the verbs: runs the compiler and prints its diagnostics in the way the user asked
// for.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "compiler/emit/compile.h"
#include "runtime/cli/verbs.h"

namespace probe::cli {

struct CompiledText {
  std::vector<std::byte> plan;  // empty unless asked for
  std::size_t errors = 0, warnings = 0;
  int exit = kFine;                  // kUser when there were errors
  std::string said;                  // the diagnostics, as text or as JSON
  bool only_assets_missing = false;  // every error is a P0202
  std::vector<std::string> files;    // every file that was read, as it was found
  std::vector<std::string> unused_phrases;
  std::vector<ReferringWords> referring;
  std::vector<ChosenStarts> chosen;
  AssetRoot asset_root;                 // where files were looked for
  std::size_t tasks = 0, starts = 0;    // that were looked at
  std::vector<std::string> own_suites;  // declared by the named files, not by those they use
};

// The same in two steps: nothing is printed but a Failure of the outside, and then what was said.
// `chosen_only`: just the tasks of AssetOptions::tasks. `plans`: where none is wanted here.
CompiledText compile_quietly(const std::vector<std::string>& files, const AssetOptions& assets,
                             const std::string& suite, bool want_plan, bool json = false,
                             bool chosen_only = false, const PlanTaker& plans = {});
void print_diagnostics(const CompiledText& text, bool json);

// What a verb says that has other things to say: mistakes as they are, of warnings how many there
// are and who shows them.
void say_briefly(const CompiledText& text, const std::string& file);
void say_briefly(const Compilation& compilation, const std::string& file);

// Diagnostics go to stderr as text, or to stdout as JSON with `json`. When nothing but assets is
// missing and AssetOptions::tasks says which tasks are wanted, those alone are compiled, with a
// note.
CompiledText compile_text(const std::vector<std::string>& files, const AssetOptions& assets,
                          const std::string& suite, bool want_plan, bool json = false,
                          bool brief = false, const PlanTaker& plans = {});

}  // namespace probe::cli
