// Folders of one search that was shared out among several calls, joined.
#pragma once

#include <string>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/store/merge.h"

namespace probe::search {

// In: folders of one search, another shard each. Out: `out` with their rounds, their episodes and
// what the expert solved. What was found is told by the same `search` command on `out`, which runs
// what is missing. Fails (kUsage) where the folders were begun with different things, and as
// store::merge does; nothing of a round is written then. Called again it continues.
Result<store::MergeSummary> merge_searches(const store::MergeOptions& options);

}  // namespace probe::search
