// Rates in a simulation against rates in reality, of the same policies: whether policies keep their
// order (MMRV) and whether the rates lie on a line (Pearson), column by column; for a table of
// published rates, one a row, and for runs beside it.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/base/json.h"
#include "runtime/base/result.h"
#include "runtime/report/benchmark.h"
#include "runtime/stats/rank_agreement.h"

namespace probe::report {

// One row of the table, a rate from 0 to 1 or a figure of agreement.
struct PublishedFigure {
  std::string source, protocol, metric, policy, task, subtask;
  double value = 0;
  int decimals = 0;   // digits behind the point
  double trials = 0;  // of which it is the rate; 0: not said
  std::size_t line = 0;
};

struct RateTable {
  std::string file;
  std::vector<PublishedFigure> figures;  // in the order of the file
  std::vector<std::string> unread;       // rows whose value is no number, such as a range
};

// A CSV of one figure a row, with the columns source, protocol, metric, policy, task, subtask and
// value in any order. `trials_per_published_protocol` (or `trials`) is read where it is there,
// other columns are passed over. Fails (kUsage, where = file:line) on a column that is missing or
// there twice, a row of another length, a line break in a cell, a success_rate that is not from 0
// to 1, and a figure that the same source gives twice.
Result<RateTable> parse_rate_table(std::string_view csv, const std::string& file);

// The protocol of real rates, and what runs that are added are called.
inline constexpr std::string_view kReal = "real", kTheseRuns = "these runs";

// Appends the runs' rates of success, of tasks in sets that are called as columns are: task and
// subtask joined by `_`, the task alone for the subtask `average`. Only of policies that the table
// has real rates of, by name; trials are starts, as episodes of one are not independent. What of
// the runs was left out, and which rates are of a part of their set, a sentence each.
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
