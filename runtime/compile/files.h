// .probe files compiled with this machine's assets and standard library. Prints nothing.
#pragma once

#include <atomic>
#include <map>
#include <string>
#include <vector>

#include "compiler/emit/compile.h"
#include "runtime/base/result.h"

namespace probe::compile {

struct FilesRequest {
  std::string assets = {};   // their folder; empty: found by itself (base/asset_root.h)
  std::string library = {};  // the folder that holds std/; empty: found by itself (library.h)
  std::string suite = {};    // the one suite to compile; empty: all
  // Glob over the tasks to keep, with or without their suite's prefix; empty: all.
  std::string tasks = {};
  bool wants_plan = true;
  // As in CompileOptions: what is not saved, and whether an answer is still wanted.
  std::map<std::string, std::string> unsaved = {};
  const std::atomic<bool>* stop = nullptr;
};

// A text with mistakes is no failure: its diagnostics say them. Fails (kAsset, kUsage, kIo) as
// find_asset_root(), find_library_folders() and the compiler do.
Result<Compilation> compile_files(const std::vector<std::string>& files,
                                  const FilesRequest& request);

// Whether there are errors, and each is of an asset that is not there or not as it was: another
// choice of tasks may do without it.
bool lacks_only_assets(const Diagnostics& diagnostics);

}  // namespace probe::compile
