#include "runtime/rejudge/readings.h"

#include <algorithm>

#include "runtime/base/glob.h"
#include "runtime/rejudge/stored.h"
#include "runtime/store/proof.h"
#include "runtime/store/run_plan.h"
#include "runtime/store/store.h"

namespace probe::rejudge {
namespace {

struct SuiteJobs {
  Reading reading;
  std::vector<Job> jobs;
  std::size_t next = 0;  // the first job whose row has not been read
};

Result<std::vector<SuiteJobs>> jobs_of(const plan::Plan& plan, const plan::Plan& recorded,
                                       std::span<const store::ResultRow> rows,
                                       std::span<const std::string> suites,
                                       const std::string& tasks) {
  std::vector<SuiteJobs> all;
  std::string known;
  bool any = false;
  for (const plan::SuiteRecord& suite : plan.suites()) {
    const std::string name(plan.text(suite.name));
    known += (known.empty() ? "" : ", ") + name;
    const auto is_chosen = [&](const std::string& glob) { return matches_glob(glob, name); };
    if (!std::ranges::any_of(suites, is_chosen)) continue;
    any = true;
    SuiteJobs one;
    one.reading.suite = name;
    PROBE_ASSIGN(one.jobs, match_rows(plan, recorded, rows, name, tasks, one.reading.left_out));
    if (!one.jobs.empty()) all.push_back(std::move(one));
  }
  if (!any)
    return Failure{Fault::kUsage, "no suite of the judging plan is meant; it has " + known, ""};
  if (all.empty()) return Failure{Fault::kUsage, "none of these suites judges a stored task", ""};
  return all;
}

void count_row(const plan::Plan& plan, const store::Trace& trace, const Rescored& score,
               SuiteJobs& suite) {
  const Job& job = suite.jobs[suite.next];
  Reading& reading = suite.reading;
  const store::ResultRow row = judged_row(plan, job, score, trace);
  if (store::is_not_attempted(row)) {
    reading.not_attempted.add(row);
    return;
  }
  if (row.invalid || job.row->invalid) {
    ++reading.invalid;
    return;
  }
  ++reading.valid;
  count_changes(reading.metrics, *job.row, row);
  if (reading.tasks.empty() || reading.tasks.back().task != job.row->task)
    reading.tasks.push_back({job.row->task, {}});
  count_changes(reading.tasks.back().metrics, *job.row, row);
}

}  // namespace

Result<std::vector<Reading>> read_under(const std::string& dir, const plan::Plan& plan,
                                        std::span<const std::string> suites,
                                        const std::string& tasks) {
  PROBE_ASSIGN(const auto rows, store::read_results(dir));
  PROBE_ASSIGN(const plan::Plan recorded, store::open_run_plan(dir));
  PROBE_ASSIGN(auto all, jobs_of(plan, recorded, rows, suites, tasks));
  for (const store::ResultRow& row : rows) {
    std::optional<store::Trace> trace;
    for (SuiteJobs& suite : all) {
      if (suite.next == suite.jobs.size() || suite.jobs[suite.next].row != &row) continue;
      if (!trace) {
        PROBE_ASSIGN(trace, store::prove(recorded, row));
      }
      PROBE_ASSIGN(const Rescored score, rescore(plan, suite.jobs[suite.next].match.task, *trace));
      count_row(plan, *trace, score, suite);
      ++suite.next;
    }
  }
  std::vector<Reading> readings;
  for (SuiteJobs& suite : all) readings.push_back(std::move(suite.reading));
  return readings;
}

}  // namespace probe::rejudge
