// One rule for all who show results: a row counts only if its trace bears it. Whoever edits a
// database, cuts a trace or flips a verdict would have to make up a whole trace whose measurements
// lead to that verdict.
#pragma once

#include <string>
#include <vector>

#include "runtime/base/cache_folder.h"
#include "runtime/plan/plan.h"
#include "runtime/store/results.h"
#include "runtime/store/trace.h"

namespace probe::store {

// The row's trace. Fails (kTrace, where = its file) unless it is whole, the row's own
// (read_stored_trace), of an episode of `plan`, as long as the row says and a valid one as long as
// the task, told and shown what the row's hashes say, with the verdicts that the plan gives it.
Result<Trace> prove(const plan::Plan& plan, const ResultRow& row);

// What a row has of its task and of the last step of its trace, which bears it: `idle`, `delay`,
// `joints`.
void add_task(const plan::Plan& plan, const Trace& trace, ResultRow& row);

policy::LiveFigures live_figures(const Trace& trace);

// What is told of a run beside its rows.
struct ProvenRun {
  std::vector<std::string> refused;  // a sentence each: which episode, and what is wrong
  // Of a run whose world does not wait: its terms, and how often and how late its policy answered
  // in valid episodes. Empty: it waits.
  std::string live_terms;
  policy::LiveFigures live;
  bool only_success = false;  // RunIdentity::only_success
};

// Calls `visit` with the rows of a run that their traces bear, as for_each_row has them, with
// `idle`, `delay`, `joints`. Reads traces on every core, some thousand rows ahead; those that were
// proven before and have not changed since are not read again (ProofBook, in the folder `book`;
// empty: all are read). Fails as for_each_row and open_run_plan do.
Result<ProvenRun> for_each_proven_row(const std::string& dir, const RowVisitor& visit,
                                      const std::string& book = cache_folder("proofs"));

struct ProvenResults : ProvenRun {
  std::vector<ResultRow> rows;
};

// All of them at once.
Result<ProvenResults> read_proven_results(const std::string& dir);

}  // namespace probe::store
