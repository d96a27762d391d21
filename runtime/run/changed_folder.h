// A folder that was begun with something else than what is asked now: go on in it, take the next of
// its name, or refuse. Runs and answers are decided alike.
#pragma once

#include <string>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/run/run.h"

namespace probe::run {

// What differs, as sentences without the folder's name; empty where equal. Over another identity no
// folder is gone on with.
struct FolderChanges {
  std::string identity, content, build;
};

// Whether to go on in `dir`; if not, the next folder of its name is meant. What was done is noted.
// Fails (kStore, at `dir`) with what differs and what can be said instead.
Result<bool> goes_on(const std::string& dir, const FolderChanges& changes, IfChanged if_changed,
                     std::vector<std::string>& notes);

// For a folder whose policy acts otherwise than what is asked now: noted where the call says
// `continue`, else a failure (kStore, at `dir`) with what can be said instead, and `also`.
Status goes_on_mixed(const std::string& dir, const std::string& said, IfChanged if_changed,
                     std::vector<std::string>& notes, const std::string& also = "");

}  // namespace probe::run
