// The verbs of the command line, one file each. A verb parses its own arguments, calls the library
// that does the work and prints: data on stdout, words on stderr. No logic lives here.
#pragma once

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <string>
#include <vector>

#include "runtime/base/result.h"

namespace probe::cli {

// Exit codes of the program: fine, the user's text or arguments, the outside, our mistake
// (check_failed uses 3 too).
enum Exit : int { kFine = 0, kUser = 1, kOutside = 2, kOurs = 3 };

// Prints "vlaprobe: ..." and says with which code to leave.
int report(const Failure& failure);

// Options every verb that compiles or opens assets has.
struct AssetOptions {
  std::string root;     // empty: found by itself
  std::string library;  // the folder that holds std/; empty: found by itself
  // Glob over the tasks that are wanted. Where the assets lack what others need, only these are
  // compiled; empty: all.
  std::string tasks;
};
void add_asset_option(CLI::App& verb, AssetOptions& options);

// Each adds its verb; the callback stores the exit code.
void add_assets(CLI::App& app, int& exit);
void add_audit(CLI::App& app, int& exit);
void add_check(CLI::App& app, int& exit);
void add_build(CLI::App& app, int& exit);
void add_doctor(CLI::App& app, int& exit);
void add_explain(CLI::App& app, int& exit);
void add_fmt(CLI::App& app, int& exit);
void add_list(CLI::App& app, int& exit);
void add_show(CLI::App& app, int& exit);
void add_diff(CLI::App& app, int& exit);
void add_coverage(CLI::App& app, int& exit);
void add_graph(CLI::App& app, int& exit);
void add_draw(CLI::App& app, int& exit);
void add_dis(CLI::App& app, int& exit);
void add_verify(CLI::App& app, int& exit);
void add_policy(CLI::App& app, int& exit);
void add_preview(CLI::App& app, int& exit);
void add_sheet(CLI::App& app, int& exit);
void add_run(CLI::App& app, int& exit);
void add_merge(CLI::App& app, int& exit);
void add_slurm(CLI::App& app, int& exit);
void add_sweep(CLI::App& app, int& exit);
void add_results(CLI::App& app, int& exit);
void add_replay(CLI::App& app, int& exit);
void add_judge(CLI::App& app, int& exit);
void add_why(CLI::App& app, int& exit);
void add_report(CLI::App& app, int& exit);
void add_compare(CLI::App& app, int& exit);
void add_export(CLI::App& app, int& exit);

// The program: parses, runs one verb, returns the exit code.
int main(int argc, char** argv);

}  // namespace probe::cli
