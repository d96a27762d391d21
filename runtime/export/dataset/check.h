// Reads an exported dataset back and holds it against the traces of the runs that it was made of.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "runtime/base/asset_root.h"
#include "runtime/base/result.h"

namespace probe::dataset {

struct CheckReport {
  std::int64_t demonstrations = 0, episodes = 0, frames = 0;
  std::int64_t not_redrawn = 0;  // of the frames: pictures that nothing was held against
  // A sentence each, with the place: what is not as the format or the traces have it.
  std::vector<std::string> problems;
};

struct CheckOptions {
  // Where the runs are now, in the order in which the dataset names them; empty: where it says.
  std::vector<std::string> runs = {};
  AssetRoot assets = {};  // as find_asset_root() takes it
  // Pictures that are no copies of what the policy saw (resized, or in a video) are held against
  // the run's, which are drawn again and proved; false: they are only counted and measured.
  bool redraws = true;
};

// What a damaged dataset has wrong are problems; fails (kUsage or kIo) where `dir` is no dataset of
// ours, and as readers of runs and of assets do.
Result<CheckReport> check_dataset(const std::string& dir, const CheckOptions& options = {});

}  // namespace probe::dataset
