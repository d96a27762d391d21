// Three proofs: the hash that the row keeps, whose trace the header says it is, and its last words.
#include "runtime/store/stored_trace.h"

#include <algorithm>

#include "runtime/base/spelling.h"
#include "runtime/store/episode_key.h"
#include "runtime/store/proof.h"
#include "runtime/store/run_plan.h"
#include "runtime/store/store.h"

namespace probe::store {

Result<Trace> read_stored_trace(const ResultRow& row) {
  PROBE_ASSIGN(Trace trace, read_trace(row.trace));
  const TraceHeader& header = trace.header;
  if (to_hex(trace.hash) != row.trace_sha256 || key_of(header) != key_of(row) ||
      header.policy != row.policy || to_hex(header.start_id) != row.start_id ||
      to_hex(header.episode_id) != row.episode_id) {
    return Failure{Fault::kTrace,
                   "this trace is not the one its result row was made with (it is of " +
                       to_text(key_of(header)) + ", policy `" + header.policy + "`)",
                   row.trace};
  }
  // A row may become invalid after its trace ended, where it was not shown who answered.
  const bool was_exchanged =
      row.invalid && !trace.end->invalid &&
      std::ranges::any_of(Store::kLaterReasons,
                          [&](std::string_view reason) { return row.invalid->ends_with(reason); });
  const bool ended_so = trace.end->invalid == row.invalid || was_exchanged;
  if (!ended_so || (!row.invalid && trace.end->metrics != row.metrics)) {
    return Failure{Fault::kTrace, "this trace ended with other verdicts than its result row says",
                   row.trace};
  }
  return trace;
}

Result<StoredTrace> find_trace(const std::string& dir, const std::string& task, int episode,
                               std::optional<int> seed) {
  PROBE_ASSIGN(const auto rows, read_results(dir));
  const ResultRow* found = nullptr;
  bool has_task = false, has_episode = false;
  for (const ResultRow& row : rows) {
    if (row.task != task) continue;
    has_task = true;
    if (row.episode != episode) continue;
    has_episode = true;
    if (seed ? row.seed == *seed : found == nullptr) found = &row;
  }
  if (found == nullptr) {
    const std::string name = "task `" + task + "`";
    if (!has_task) {
      std::vector<std::string> names;
      for (const ResultRow& row : rows) names.push_back(row.task);
      return Failure{Fault::kUsage, "this run has no " + name + did_you_mean(task, names), dir};
    }
    if (!has_episode) {
      return Failure{Fault::kUsage, name + " has no stored episode " + std::to_string(episode),
                     dir};
    }
    return Failure{Fault::kUsage,
                   "episode " + std::to_string(episode) + " of " + name + " has no seed " +
                       std::to_string(*seed),
                   dir};
  }
  PROBE_ASSIGN(const plan::Plan plan, open_run_plan(dir));
  PROBE_ASSIGN(Trace trace, prove(plan, *found));
  return StoredTrace{*found, std::move(trace)};
}

}  // namespace probe::store
