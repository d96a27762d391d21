// `vlaprobe merge`: the rows and traces of several folders in one, each episode once. What comes
// out has the rows that a single run of the same episodes has.
#pragma once

#include <string>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/store/not_attempted.h"

namespace probe::store {

struct MergeOptions {
  std::vector<std::string> dirs;  // folders of runs; one named twice counts once
  std::string out;                // made if absent; a run there counts as one more of `dirs`
  bool mixed_builds = false;      // join shards of other builds and machines too
};

struct MergeSummary {
  int rows = 0;        // in `out` now
  int added = 0;       // of them new or better than what was there
  int duplicates = 0;  // rows that another folder had too, or had valid
  int invalid = 0;     // rows in `out` that are neither valid nor
  NotAttempted not_attempted;
  int left_out = 0;  // rows that their traces do not show, each named in `notes`
  int unvouched = 0;  // answers that do not follow from what they hold: invalid in `out`
  std::vector<std::string> notes;
};

// Fails (kUsage) when a folder holds no run, or one of another plan, policy, profile or
// (unless mixed_builds) build than the first, and (kStore) when two folders have the same
// episode with different traces, a folder's plan is not that of its record, or no row at all is
// shown by its trace; nothing is written then. Valid rows win over invalid ones; a row
// that its trace does not bear counts as absent, with a note. Called again it continues.
Result<MergeSummary> merge(const MergeOptions& options);

}  // namespace probe::store
