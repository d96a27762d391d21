// Stored episodes and the tasks of a plan that judge them again. Private to this folder.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "runtime/rejudge/match.h"
#include "runtime/rejudge/rescore.h"
#include "runtime/store/results.h"
#include "runtime/store/trace.h"

namespace probe::rejudge {

struct Job {
  const store::ResultRow* row;
  Match match;
};

// Every stored episode that the plan judges, as far as `tasks`, a glob over the stored names,
// allows; tasks that it does not judge are left out and named. Fails (kUsage) when a start
// differs. `suite` is whose tasks judge; empty: all tasks of the plan.
Result<std::vector<Job>> match_rows(const plan::Plan& plan, const plan::Plan& recorded,
                                    std::span<const store::ResultRow> rows,
                                    const std::string& suite, const std::string& tasks,
                                    std::vector<std::string>& left_out);

// Why match_rows gave nothing.
Failure nothing_judged(const std::string& suite, const std::string& tasks,
                       std::span<const std::string> left_out);

// The row as judged now.
store::ResultRow judged_row(const plan::Plan& plan, const Job& job, const Rescored& score,
                            const store::Trace& trace);

}  // namespace probe::rejudge
