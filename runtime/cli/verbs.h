// The verbs of the command line, one file each. A verb says its own arguments, calls the library
// that does the work and prints: data on stdout, words on stderr. No logic lives here.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "runtime/base/asset_root.h"
#include "runtime/base/result.h"
#include "runtime/cli/arguments.h"

namespace probe::cli {

// Exit codes of the program: fine, the user's text or arguments, the outside, our mistake
// (check_failed uses 3 too).
enum Exit : int { kFine = 0, kUser = 1, kOutside = 2, kOurs = 3 };
// No exit code: this program cannot do it, the one with the simulator can. Nothing was printed yet.
constexpr int kHandOver = -1;

// As --version prints it.
const char* version();

// Prints "vlaprobe: ..." and says with which code to leave.
int report(const Failure& failure);

// Options every verb that compiles or opens assets has.
struct AssetOptions {
  std::vector<std::string> folders;  // of assets, in order; none: found by itself
  std::string library;  // the folder that holds std/; empty: found by itself
  // Glob over the tasks that are wanted. Where the assets lack what others need, only these are
  // compiled; empty: all.
  std::string tasks;
};
void add_asset_option(Verb verb, AssetOptions& options, bool is_in_help = true);
// As they were named.
AssetRoot root_of(const AssetOptions& options);

// Each adds its verb; the callback stores the exit code. These need the compiler alone, no world,
// no run; those that do are in full/.
void add_audit(Verb app, int& exit);
void add_check(Verb app, int& exit);
void add_build(Verb app, int& exit);
void add_explain(Verb app, int& exit);
void add_fmt(Verb app, int& exit);
void add_list(Verb app, int& exit);
void add_lsp(Verb app, int& exit);
void add_show(Verb app, int& exit);
void add_diff(Verb app, int& exit);
void add_coverage(Verb app, int& exit);
void add_graph(Verb app, int& exit);
void add_rephrase(Verb app, int& exit);
void add_dis(Verb app, int& exit);
void add_verify(Verb app, int& exit);

}  // namespace probe::cli
