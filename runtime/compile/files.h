// .probe files compiled with this machine's assets and standard library. Prints nothing.
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "compiler/emit/compile.h"
#include "runtime/base/asset_root.h"
#include "runtime/base/result.h"
#include "runtime/plan/plan.h"

namespace probe::compile {

struct FilesRequest {
  AssetRoot assets = {};     // empty: found by itself
  std::string library = {};  // the folder that holds std/; empty: found by itself (library.h)
  std::string suite = {};    // the one suite to compile; empty: all
  // Glob over the tasks to keep, with or without their suite's prefix; empty: all.
  std::string tasks = {};
  bool wants_plan = true;
  // As in CompileOptions: what is not saved, and whether an answer is still wanted.
  std::map<std::string, std::string> unsaved = {};
  const std::atomic<bool>* stop = nullptr;
  PlanTaker plans = {};  // where no plan is wanted
};

// A text with mistakes is no failure: its diagnostics say them. Fails (kAsset, kUsage, kIo) as
// find_asset_root(), find_library_folders() and the compiler do.
Result<Compilation> compile_files(const std::vector<std::string>& files,
                                  const FilesRequest& request);

// Where the files of a plan are looked for when it is run, as AssetRoot::kept_for says: `root` as of
// the text that it was compiled from.
AssetRoot root_for(const plan::Plan& plan, const AssetRoot& root);
// The same of a .plan file at `path`, near which models may lie as beside a text. Nothing where this
// machine has no assets: not every reader of a plan needs them.
AssetRoot root_for_file(const plan::Plan& plan, const std::string& path, const AssetRoot& chosen);

// Whether there are errors, and each is of an asset that is not there or not as it was: another
// choice of tasks may do without it.
bool lacks_only_assets(const Diagnostics& diagnostics);

}  // namespace probe::compile
