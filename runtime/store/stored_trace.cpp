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
      row.invalid && !trace.end->invalid && Store::is_later_reason(*row.invalid);
  const bool ended_so = trace.end->invalid == row.invalid || was_exchanged;
  if (!ended_so || (!row.invalid && trace.end->metrics != row.metrics)) {
    return Failure{Fault::kTrace, "this trace ended with other verdicts than its result row says",
                   row.trace};
  }
  return trace;
}

Result<StoredTrace> find_trace(const std::string& dir, const std::string& task, int episode,
                               std::optional<int> seed) {
  PROBE_ASSIGN(const auto rows, read_episode(dir, task, episode));
  if (rows.empty()) {
    const std::string name = "task `" + task + "`";
    PROBE_ASSIGN(const auto tasks, read_stored_tasks(dir));
    if (std::ranges::find(tasks, task) == tasks.end())
      return Failure{Fault::kUsage, "this run has no " + name + did_you_mean(task, tasks), dir};
    return Failure{Fault::kUsage, name + " has no stored episode " + std::to_string(episode), dir};
  }
  const auto found = seed ? std::ranges::find(rows, *seed, &ResultRow::seed) : rows.begin();
  if (found == rows.end()) {
    return Failure{Fault::kUsage,
                   "episode " + std::to_string(episode) + " of task `" + task + "` has no seed " +
                       std::to_string(*seed),
                   dir};
  }
  PROBE_ASSIGN(const plan::Plan plan, open_run_plan(dir));
  PROBE_ASSIGN(Trace trace, prove(plan, *found));
  return StoredTrace{*found, std::move(trace)};
}

}  // namespace probe::store
