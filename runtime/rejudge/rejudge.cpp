#include "runtime/rejudge/rejudge.h"

#include <algorithm>
#include <filesystem>
#include <map>

#include "runtime/rejudge/match.h"
#include "runtime/rejudge/rescore.h"
#include "runtime/run/glob.h"
#include "runtime/run/store.h"
#include "runtime/run/trace.h"

namespace probe::rejudge {
namespace {

namespace fs = std::filesystem;

struct Job {
  const run::ResultRow* row;
  Match match;
};

Result<std::vector<std::uint32_t>> candidates_of(const plan::Plan& plan, const std::string& suite) {
  std::vector<std::uint32_t> tasks;
  if (suite.empty()) {
    for (std::uint32_t t = 0; t < plan.tasks().size(); ++t) tasks.push_back(t);
    return tasks;
  }
  const auto index = plan.find_suite(suite);
  if (!index) return Failure{"usage", "the judging plan has no such suite", suite};
  const auto members = plan.members(plan.suites()[*index]);
  tasks.assign(members.begin(), members.end());
  return tasks;
}

// Every stored episode that the plan judges. Tasks it does not have are left out and named.
Result<std::vector<Job>> match_rows(const plan::Plan& plan, const plan::Plan& recorded,
                                    std::span<const run::ResultRow> rows,
                                    const RejudgeOptions& options, RejudgeReport& report) {
  PROBE_ASSIGN(const auto candidates, candidates_of(plan, options.suite));
  std::map<std::string, std::optional<std::uint32_t>> judges;
  std::vector<Job> jobs;
  for (const run::ResultRow& row : rows) {
    if (!run::matches_glob(options.tasks, row.task)) continue;
    const auto [known, is_new] = judges.try_emplace(row.task);
    if (is_new) {
      PROBE_ASSIGN(known->second, find_judge(plan, candidates, row.task));
      if (!known->second) report.left_out.push_back(row.task);
    }
    if (!known->second) continue;
    PROBE_ASSIGN(const Match match, match_start(plan, *known->second, row, recorded));
    jobs.push_back({&row, match});
  }
  if (!jobs.empty()) return jobs;
  if (judges.empty())
    return Failure{"usage", "no stored episode matches `" + options.tasks + "`", ""};
  return Failure{
      "usage",
      "the judging plan has none of the stored tasks, such as `" + judges.begin()->first + "`",
      options.suite};
}

Result<run::Trace> trace_of(const run::ResultRow& row) {
  PROBE_ASSIGN(run::Trace trace, run::read_trace(row.trace));
  if (to_hex(trace.hash) != row.trace_sha256) {
    return Failure{"trace", "this trace is not the one its result row was made with", row.trace};
  }
  return trace;
}

run::ResultRow judged_row(const plan::Plan& plan, const Job& job, const Rescored& score,
                          const run::Trace& trace) {
  const plan::TaskRecord& task = plan.tasks()[job.match.task];
  run::ResultRow row = *job.row;
  row.task = std::string(plan.text(task.name));
  row.metrics = score.metrics;
  row.invalid = score.invalid;
  row.steps = static_cast<int>(score.steps.size());
  Hasher frames;  // of the steps that were judged
  for (std::size_t i = 0; i < score.steps.size(); ++i) frames.hash(trace.steps[i].image_hash);
  row.frames_sha256 = row.steps > 0 ? to_hex(frames.finish()) : "";
  row.episode_id = to_hex(Sha256{plan.episodes(task)[job.match.episode].episode_id});
  return row;
}

// The trace again, with the new plan's names and verdicts in it.
Result<Sha256> write_judged(const std::string& path, const plan::Plan& plan, const Job& job,
                            const Rescored& score, const run::Trace& trace) {
  const plan::TaskRecord& task = plan.tasks()[job.match.task];
  run::TraceHeader header = trace.header;
  header.plan_root = plan.root();
  header.task = std::string(plan.text(task.name));
  header.episode_id = Sha256{plan.episodes(task)[job.match.episode].episode_id};
  header.horizon = task.horizon;
  header.bodies.clear();
  for (const plan::BodyRecord& body : plan.bodies(task))
    header.bodies.emplace_back(plan.text(body.name));
  header.metrics.clear();
  for (const run::MetricValue& metric : score.metrics)
    header.metrics.push_back({metric.name, metric.is_bool});
  PROBE_ASSIGN(auto writer, run::TraceWriter::create(path, header));
  if (trace.start) PROBE_TRY(writer->start(*trace.start));
  for (std::size_t i = 0; i < score.steps.size(); ++i) {
    run::TraceStep step = trace.steps[i];
    step.metrics = score.steps[i];
    PROBE_TRY(writer->step(step));
  }
  return writer->finish(
      {static_cast<std::uint32_t>(score.steps.size()), score.metrics, score.invalid});
}

const run::MetricValue* find_metric(const run::ResultRow& row, const std::string& name) {
  const auto it = std::ranges::find(row.metrics, name, &run::MetricValue::name);
  return it == row.metrics.end() ? nullptr : &*it;
}

void count(std::vector<MetricChange>& changes, const run::ResultRow& before,
           const run::ResultRow& after) {
  const auto change_of = [&](const run::MetricValue& metric) -> MetricChange& {
    const auto it = std::ranges::find(changes, metric.name, &MetricChange::name);
    if (it != changes.end()) return *it;
    changes.push_back({.name = metric.name, .is_bool = metric.is_bool});
    return changes.back();
  };
  for (const run::MetricValue& old : before.metrics) {
    MetricChange& change = change_of(old);
    const run::MetricValue* now = find_metric(after, old.name);
    if (now == nullptr || now->is_bool != old.is_bool) {
      ++change.only_before;
      continue;
    }
    ++change.episodes;
    change.before += old.value != 0;
    change.after += now->value != 0;
    change.lost += old.value != 0 && now->value == 0;
    change.gained += old.value == 0 && now->value != 0;
    change.changed += old.value != now->value;
    // Running means, so that a million episodes do not lose digits.
    change.mean_before += (old.value - change.mean_before) / change.episodes;
    change.mean_after += (now->value - change.mean_after) / change.episodes;
  }
  for (const run::MetricValue& now : after.metrics) {
    if (find_metric(before, now.name) == nullptr) ++change_of(now).only_after;
  }
}

}  // namespace

Result<RejudgeReport> rejudge(const std::string& dir, const plan::Plan& plan,
                              const RejudgeOptions& options) {
  PROBE_ASSIGN(const run::RunRecord record, run::read_run_record(dir));
  PROBE_ASSIGN(const auto rows, run::read_results(dir));
  PROBE_ASSIGN(const plan::Plan recorded, plan::Plan::open(run::plan_path(dir)));
  if (!options.out.empty()) {
    std::error_code error;
    if (fs::equivalent(options.out, dir, error)) {
      return Failure{"usage", "the folder that is judged is not overwritten", options.out};
    }
  }
  RejudgeReport report;
  report.same_plan = plan.root() == recorded.root();
  PROBE_ASSIGN(const auto jobs, match_rows(plan, recorded, rows, options, report));
  // All refusals come before the first byte is written.
  for (const Job& job : jobs) {
    PROBE_ASSIGN(const run::Trace trace, trace_of(*job.row));
    PROBE_TRY(check_measures(plan, job.match.task, trace));
  }

  std::unique_ptr<run::Store> store;
  if (!options.out.empty()) {
    run::RunRecord judged = record;
    judged.identity.plan_root = to_hex(plan.root());
    if (!options.suite.empty()) judged.suite = options.suite;
    PROBE_ASSIGN(store, run::Store::open(options.out, judged, plan.bytes()));
  }
  for (const Job& job : jobs) {
    PROBE_ASSIGN(const run::Trace trace, trace_of(*job.row));
    PROBE_ASSIGN(const Rescored score, rescore(plan, job.match.task, trace));
    run::ResultRow row = judged_row(plan, job, score, trace);
    if (store) {
      const std::string path = store->temporary_trace(row.task, row.episode, row.seed);
      PROBE_ASSIGN(const Sha256 hash, write_judged(path, plan, job, score, trace));
      row.trace_sha256 = to_hex(hash);
      PROBE_TRY(store->commit(row, static_cast<int>(job.match.task)));
      row.trace = fs::absolute(run::trace_path(options.out, row.task, row.episode, row.seed))
                      .lexically_normal()
                      .string();
    }
    if (row.invalid || job.row->invalid) {
      ++report.invalid;
    } else {
      ++report.valid;
      count(report.metrics, *job.row, row);
    }
    report.rows.push_back(std::move(row));
  }
  return report;
}

}  // namespace probe::rejudge
