// The plan of a run's folder, believed only if it is the one that the run was made with.
#pragma once

#include <string>
#include <vector>

#include "runtime/base/asset_root.h"
#include "runtime/base/result.h"
#include "runtime/plan/plan.h"

namespace probe::store {

// Fails (kStore, where = the file) when it is absent, damaged or of another root than the run's
// record names, and as read_run_record does.
Result<plan::Plan> open_run_plan(const std::string& dir);

// Where the files of a run's plan lie: `chosen` where it is not empty; else where the run had them
// from, as long as these folders are there; else as find_asset_root() says.
Result<AssetRoot> find_run_assets(const std::string& dir, const AssetRoot& chosen);

// The models and pictures that such a replay or sheet is drawn from, where they lie; none where the
// run's plan or its assets cannot be read.
std::vector<std::string> files_of_run(const std::string& dir, const AssetRoot& chosen);

}  // namespace probe::store
