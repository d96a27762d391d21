#include "runtime/store/proof.h"

#include <algorithm>
#include <atomic>
#include <optional>
#include <system_error>
#include <thread>

#include "runtime/store/episode_key.h"
#include "runtime/store/run_plan.h"
#include "runtime/store/store.h"
#include "runtime/store/stored_trace.h"
#include "runtime/vm/claims.h"
#include "runtime/vm/judge.h"

namespace probe::store {
namespace {

// Whether the metrics after every step are those that the plan's program gives.
bool is_judged_so(const plan::Plan& plan, std::uint32_t task, const Trace& trace) {
  if (!trace.start) return trace.steps.empty();
  vm::Judge judge(plan, task);
  if (!judge.begin(trace.start->starts)) return false;
  // Where the words of the task are not so no episode is valid.
  if (!trace.end->invalid &&
      !vm::check_claims(plan, task, trace.start->starts, trace.start->sample))
    return false;
  for (const TraceStep& step : trace.steps) {
    if (judge.ended()) return false;  // nothing comes behind the end
    if (!judge.step(step.sample)) return false;
    if (!std::ranges::equal(judge.values(), step.metrics)) return false;
  }
  // An episode that ended early says nothing of its metrics; one that did not, what it was last.
  return trace.end->invalid || trace.steps.empty() ||
         std::ranges::equal(trace.end->metrics, trace.steps.back().metrics, {},
                            &MetricValue::value);
}

std::string difference(const plan::Plan& plan, const ResultRow& row, const Trace& trace) {
  const auto task = plan.find_task(row.task);
  if (!task || trace.header.plan_root != plan.root()) {
    return "this trace was not made under the stored plan";
  }
  const plan::TaskRecord& record = plan.tasks()[*task];
  const auto episodes = plan.episodes(record);
  const auto index = static_cast<std::size_t>(row.episode);
  if (row.episode < 0 || index >= episodes.size() ||
      trace.header.episode_id != Sha256{episodes[index].episode_id} ||
      trace.header.start_id != Sha256{episodes[index].start_id}) {
    return "the stored plan has no such episode";
  }
  const std::size_t steps = trace.steps.size();
  if (static_cast<std::size_t>(std::max(row.steps, 0)) != steps) {
    return "this trace has " + std::to_string(steps) + " steps, its result row says " +
           std::to_string(row.steps);
  }
  const auto ends = plan.ends_metric(record);
  const bool has_ended = ends && steps > 0 && steps < record.horizon &&
                         *ends < trace.steps.back().metrics.size() &&
                         trace.steps.back().metrics[*ends] != 0;
  if (!row.invalid && steps != record.horizon && !has_ended) {
    return "this trace has " + std::to_string(steps) + " of the task's " +
           std::to_string(record.horizon) + " steps and gives no reason";
  }
  if (is_judged_so(plan, *task, trace)) return "";
  return "its verdicts are not what its own plan says of its measurements";
}

std::string terms_of(const Trace& trace) {
  return trace.header.live ? to_text(*trace.header.live) : "";
}

}  // namespace

void add_task(const plan::Plan& plan, const Trace& trace, ResultRow& row) {
  const plan::TaskRecord& task = plan.tasks()[*plan.find_task(row.task)];
  row.idle = static_cast<int>(task.idle);
  row.delay = static_cast<int>(task.delay);
  if (row.invalid || trace.steps.empty()) return;
  const std::size_t robots = plan.robots()[plan.scenes()[task.scene].robot].drives.count;
  for (std::size_t j = robots; j < trace.header.joints.size(); ++j)
    row.joints.push_back({trace.header.joints[j], trace.steps.back().q[j]});
}

policy::LiveFigures live_figures(const Trace& trace) {
  policy::LiveFigures figures;
  for (std::size_t i = 0; i < trace.steps.size(); ++i) {
    if (trace.steps[i].live) figures.add(static_cast<int>(i), *trace.steps[i].live);
  }
  return figures;
}

Result<Trace> prove(const plan::Plan& plan, const ResultRow& row) {
  PROBE_ASSIGN(Trace trace, read_stored_trace(row));
  std::string wrong = difference(plan, row, trace);
  if (wrong.empty()) return trace;
  return Failure{Fault::kTrace, std::move(wrong), row.trace};
}

Result<ProvenResults> read_proven_results(const std::string& dir) {
  PROBE_ASSIGN(std::vector<ResultRow> rows, read_results(dir));
  PROBE_ASSIGN(const plan::Plan plan, open_run_plan(dir));
  PROBE_ASSIGN(const RunRecord record, read_run_record(dir));
  ProvenResults proven;
  proven.live_terms = record.identity.live;
  proven.only_success = record.identity.only_success;
  std::vector<std::optional<Failure>> wrong(rows.size());
  std::vector<policy::LiveFigures> live(rows.size());
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    for (std::size_t i = next++; i < rows.size(); i = next++) {
      const auto trace = prove(plan, rows[i]);
      if (!trace) {
        wrong[i] = trace.failure();
      } else if (const std::string terms = terms_of(*trace); terms != proven.live_terms) {
        wrong[i] = Failure{Fault::kTrace,
                           std::string("its world ") +
                               (terms.empty() ? "waited for the policy" : "was " + terms) +
                               ", that of its run " +
                               (proven.live_terms.empty() ? "waits" : "is " + proven.live_terms),
                           rows[i].trace};
      } else {
        if (!rows[i].invalid) live[i] = live_figures(*trace);
        add_task(plan, *trace, rows[i]);
      }
    }
  };
  std::vector<std::thread> others;
  const std::size_t cores = std::max(1u, std::thread::hardware_concurrency());
  try {
    for (std::size_t i = 1; i < std::min(cores, rows.size()); ++i) others.emplace_back(work);
  } catch (const std::system_error&) {  // fewer threads do the same
  }
  work();
  for (std::thread& thread : others) thread.join();

  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (wrong[i]) {
      proven.refused.push_back(to_text(key_of(rows[i])) + " is left out: " + to_text(*wrong[i]));
    } else {
      proven.rows.push_back(std::move(rows[i]));
      proven.live.add(live[i]);
    }
  }
  return proven;
}

}  // namespace probe::store
