// Rates in a simulation against rates in reality, of the same policies: whether policies keep their
// order (MMRV) and whether the rates lie on a line (Pearson), column by column; for a table of
// published rates, one a row, and for runs beside it.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "runtime/base/json.h"
#include "runtime/report/benchmark.h"
#include "runtime/report/rate_table.h"
#include "runtime/stats/rank_agreement.h"

namespace probe::report {

// What runs that are added are called, as source and protocol.
inline constexpr std::string_view kTheseRuns = "these runs";

// Appends the runs' rates of success, of tasks in sets that are called as columns are: task and
// subtask joined by `_`, the task alone for the subtask `average`. Only of policies that the table
// has real rates of, by name; trials are starts, as episodes of one are not independent. What of
// the runs was left out, and which rates are of a part of their set, or of fewer starts than every
// simulated rate of the column in the table, a sentence each.
std::vector<std::string> add_runs(RateTable& table, const Benchmark& benchmark);

// One column of one protocol of one source, against the real rates of the same policies: those of
// that source, else the first in the file.
struct AgreementRow {
  std::string source, protocol, task, subtask;
  std::vector<std::string> policies;
  std::vector<std::string> without_real, without_simulated;  // policies with one rate of the two
  stats::Agreement agreement;
};
// Where three policies or more have both rates.
std::vector<AgreementRow> agreements(const RateTable& table);

// A figure of agreement that the table states, beside what its rates give.
struct StatedAgreement {
  const PublishedFigure* stated = nullptr;
  double computed = 0;
  std::size_t policies = 0;  // whose rates that is made of
  bool is_close = false;  // within kClose and half of its last digit
};
inline constexpr double kClose = 0.003;  // what rounding rates to three digits moves
std::vector<StatedAgreement> stated_agreements(const RateTable& table,
                                               const std::vector<AgreementRow>& rows);

// Rates that no number of successes in their trials rounds to, each in a sentence with its place.
std::vector<std::string> impossible_rates(const RateTable& table);

std::string agreement_text(const RateTable& table);
Json agreement_json(const RateTable& table);

}  // namespace probe::report
