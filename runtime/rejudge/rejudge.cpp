#include "runtime/rejudge/rejudge.h"

#include "runtime/base/paths.h"
#include "runtime/rejudge/stored.h"
#include "runtime/store/proof.h"
#include "runtime/store/run_plan.h"
#include "runtime/store/store.h"
#include "runtime/store/stored_trace.h"
#include "runtime/store/until_words.h"

namespace probe::rejudge {
namespace {

// The trace again, with the new plan's names and verdicts in it.
Result<Sha256> write_judged(const std::string& path, const plan::Plan& plan, const Job& job,
                            const Rescored& score, const store::Trace& trace) {
  const plan::TaskRecord& task = plan.tasks()[job.match.task];
  store::TraceHeader header = trace.header;
  header.plan_root = plan.root();
  header.task = std::string(plan.text(task.name));
  header.episode_id = Sha256{plan.episodes(task)[job.match.episode].episode_id};
  header.horizon = task.horizon;
  const auto bodies = plan.bodies(task);  // what follows them in the trace keeps its name
  for (std::size_t i = 0; i < bodies.size(); ++i) header.bodies[i] = plan.text(bodies[i].name);
  header.metrics.clear();
  for (const store::MetricValue& metric : score.metrics)
    header.metrics.push_back({metric.name, metric.is_bool});
  PROBE_ASSIGN(auto writer, store::TraceWriter::create(path, header));
  if (trace.start) PROBE_TRY(writer->start(*trace.start));
  for (std::size_t i = 0; i < score.steps.size(); ++i) {
    store::TraceStep step = trace.steps[i];
    step.metrics = score.steps[i];
    PROBE_TRY(writer->step(step));
  }
  return writer->finish(
      {static_cast<std::uint32_t>(score.steps.size()), score.metrics, score.invalid});
}

}  // namespace

Result<RejudgeReport> rejudge(const std::string& dir, const plan::Plan& plan,
                              const RejudgeOptions& options) {
  PROBE_ASSIGN(const store::RunRecord record, store::read_run_record(dir));
  PROBE_ASSIGN(const auto rows, store::read_results(dir));
  PROBE_ASSIGN(const plan::Plan recorded, store::open_run_plan(dir));
  if (!options.out.empty()) {
    if (is_same(options.out, dir)) {
      return Failure{Fault::kUsage, "the folder that is judged is not overwritten", options.out};
    }
    // Under other rules its order and what it was decided against would mean something else.
    if (!record.identity.until.empty()) {
      return Failure{Fault::kUsage,
                     store::what_chose(record.identity.until) +
                         ", which a folder of other verdicts would not say: judge it without -o; " +
                         store::way_out(record.identity.until),
                     dir};
    }
  }
  RejudgeReport report;
  report.same_plan = plan.root() == recorded.root();
  PROBE_ASSIGN(const auto jobs,
               match_rows(plan, recorded, rows, options.suite, options.tasks, report.left_out));
  if (jobs.empty()) return nothing_judged(options.suite, options.tasks, report.left_out);
  // All refusals come before the first byte is written.
  for (const Job& job : jobs) {
    PROBE_ASSIGN(const store::Trace trace, store::prove(recorded, *job.row));
    PROBE_TRY(check_measures(plan, job.match.task, trace));
  }

  std::unique_ptr<store::Store> store;
  if (!options.out.empty()) {
    store::RunRecord judged = record;
    judged.identity.plan_root = to_hex(plan.root());
    if (!options.suite.empty()) judged.suite = options.suite;
    PROBE_ASSIGN(store, store::Store::open(options.out, judged, plan.bytes()));
  }
  for (const Job& job : jobs) {
    PROBE_ASSIGN(const store::Trace trace, store::read_stored_trace(*job.row));
    PROBE_ASSIGN(const Rescored score, rescore(plan, job.match.task, trace));
    store::ResultRow row = judged_row(plan, job, score, trace);
    if (store) {
      PROBE_ASSIGN(const std::string path, store->temporary_trace(store::key_of(row)));
      PROBE_ASSIGN(const Sha256 hash, write_judged(path, plan, job, score, trace));
      row.trace_sha256 = to_hex(hash);
      PROBE_TRY(store->commit(row, static_cast<int>(job.match.task)));
      row.trace = absolute_path(store::trace_path(options.out, store::key_of(row)));
    }
    if (store::is_not_attempted(row)) {
      report.not_attempted.add(row);
    } else if (row.invalid || job.row->invalid) {
      ++report.invalid;
    } else {
      ++report.valid;
      count_changes(report.metrics, *job.row, row);
    }
    report.rows.push_back(std::move(row));
  }
  return report;
}

}  // namespace probe::rejudge
