// The trace of a result row, believed only if it is the one the row was made with.
#pragma once

#include "runtime/run/results.h"
#include "runtime/run/trace.h"

namespace probe::run {

// Reads `row.trace` whole. Fails (code "trace", naming the file) when it is absent, truncated or
// damaged, when its hash is not the row's, when it is of another task, episode, seed, policy or
// start, or when its verdicts are not the row's.
Result<Trace> read_stored_trace(const ResultRow& row);

}  // namespace probe::run
