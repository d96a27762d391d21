// Three proofs: the hash that the row keeps, whose trace the header says it is, and its last words.
#include "runtime/run/stored_trace.h"

namespace probe::run {

Result<Trace> read_stored_trace(const ResultRow& row) {
  PROBE_ASSIGN(Trace trace, read_trace(row.trace));
  const TraceHeader& header = trace.header;
  if (to_hex(trace.hash) != row.trace_sha256 || header.task != row.task ||
      header.episode != row.episode || header.seed != row.seed || header.policy != row.policy ||
      to_hex(header.start_id) != row.start_id || to_hex(header.episode_id) != row.episode_id) {
    return Failure{"trace",
                   "this trace is not the one its result row was made with (it is of " +
                       header.task + " episode " + std::to_string(header.episode) + " seed " +
                       std::to_string(header.seed) + ", policy `" + header.policy + "`)",
                   row.trace};
  }
  if (trace.end->invalid != row.invalid || (!row.invalid && trace.end->metrics != row.metrics)) {
    return Failure{"trace", "this trace ended with other verdicts than its result row says",
                   row.trace};
  }
  return trace;
}

}  // namespace probe::run
