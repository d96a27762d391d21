// The model and its programs as plan records. Decides the order of records and nothing else: bytes,
// hashes and ids are the plan library's.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/diag/diagnostic.h"
#include "compiler/emit/asset_hashes.h"
#include "compiler/emit/compile.h"
#include "compiler/model/model.h"
#include "runtime/base/asset_root.h"
#include "runtime/base/result.h"

namespace probe::emit {

struct EmitOptions {
  AssetRoot asset_root;
  std::string suite;          // the one suite to keep; "" keeps all tasks
  std::string source_folder;  // paths of sources are written relative to it
  bool write = true;          // off: diagnostics only, no bytes
  AssetInspector inspect_asset = {};
  std::function<bool(std::string_view)> wants_task = {};
  bool proves = true;  // off: ids are not computed once more to be sure; of what is not kept
  AssetHashes* hashed = nullptr;  // of files that other programs have, too
};

// In: a model without errors. Out: the bytes of a plan; empty when something was reported or
// nothing was to be written. The order: sources; task after task with all it stands on (objects,
// scene, robot, views, light, program, starts), so that records stand in the order of first use;
// what the programs say of their metrics; assets; sets and suites; ids; and the last check, of
// hashes. `files`: the sources, in the order in which they are to stand in the plan.
Result<std::vector<std::byte>> emit(const sema::Model& model, const SourceSet& sources,
                                    const std::vector<FileId>& files, const EmitOptions& options,
                                    Diagnostics& diagnostics);

}  // namespace probe::emit
