// One rule for all who show results: a row counts only if its trace bears it. Whoever edits a
// database, cuts a trace or flips a verdict would have to make up a whole trace whose measurements
// lead to that verdict.
#pragma once

#include <string>
#include <vector>

#include "runtime/plan/plan.h"
#include "runtime/store/results.h"
#include "runtime/store/trace.h"

namespace probe::store {

// The row's trace. Fails (kTrace, where = its file) unless it is whole, the one the row was made
// with (read_stored_trace), of an episode of `plan`, as long as the row says and a valid one as
// long as the task, with verdicts that the plan's metrics give for its measurements at every step.
Result<Trace> prove(const plan::Plan& plan, const ResultRow& row);

// What a row has of its task and of the last step of its trace, which bears it: `idle`, `delay`,
// `joints`.
void add_task(const plan::Plan& plan, const Trace& trace, ResultRow& row);

policy::LiveFigures live_figures(const Trace& trace);

struct ProvenResults {
  std::vector<ResultRow> rows;       // as read_results has them, with `idle`, `delay`, `joints`
  std::vector<std::string> refused;  // a sentence each: which episode, and what is wrong
  // Of a run whose world does not wait: its terms, and how often and how late its policy answered
  // in valid episodes. Empty: it waits.
  std::string live_terms;
  policy::LiveFigures live;
  bool only_success = false;  // RunIdentity::only_success
};

// The rows of a run that their traces bear; reads all of them, on every core. Fails as
// read_results and open_run_plan do.
Result<ProvenResults> read_proven_results(const std::string& dir);

}  // namespace probe::store
