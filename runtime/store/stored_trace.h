// The trace of a result row, believed only if it is the one the row was made with.
#pragma once

#include "runtime/store/results.h"
#include "runtime/store/trace.h"

namespace probe::store {

// Reads `row.trace` whole. Fails (kTrace, naming the file) when it is absent, truncated or
// damaged, when its hash is not the row's, when it is of another task, episode, seed, policy or
// start, or when its verdicts are not the row's.
Result<Trace> read_stored_trace(const ResultRow& row);

// The stored row's trace of an episode; without a seed the one with the lowest. Fails
// (kUsage) when the run has no such task, episode or seed, naming what it has.
struct StoredTrace {
  ResultRow row;
  Trace trace;
};
Result<StoredTrace> find_trace(const std::string& dir, const std::string& task, int episode,
                               std::optional<int> seed);

}  // namespace probe::store
