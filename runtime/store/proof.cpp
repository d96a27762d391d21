#include "runtime/store/proof.h"

#include <algorithm>
#include <atomic>
#include <optional>
#include <system_error>
#include <thread>
#include <utility>

#include "runtime/plan/fixtures.h"
#include "runtime/plan/later.h"
#include "runtime/policy/sent_prompt.h"
#include "runtime/store/episode_key.h"
#include "runtime/store/proof_book.h"
#include "runtime/store/run_plan.h"
#include "runtime/store/store.h"
#include "runtime/store/stored_trace.h"
#include "runtime/vm/claims.h"
#include "runtime/vm/judge.h"
#include "runtime/vm/told.h"

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
  // Which sentence was said when is judged where there are several.
  vm::Told told(plan, task);
  const bool changes = !plan::later_of(plan.tables(), task).empty() || !trace.header.later.empty();
  const auto said = sentences_said(trace);
  if (!said || !told.begin(trace.start->starts)) return false;
  for (std::size_t i = 0; i < trace.steps.size(); ++i) {
    const TraceStep& step = trace.steps[i];
    if (judge.ended()) return false;  // nothing comes behind the end
    if (changes && told.sentence() != (*said)[i]) return false;
    if (!judge.step(step.sample) || !told.step(step.sample)) return false;
    if (!std::ranges::equal(judge.values(), step.metrics)) return false;
  }
  // An episode that ended early says nothing of its metrics; one that did not, what it was last.
  return trace.end->invalid || trace.steps.empty() ||
         std::ranges::equal(trace.end->metrics, trace.steps.back().metrics, {},
                            &MetricValue::value);
}

bool is_hash(std::string_view text) {
  const auto is_digit = [](char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f'); };
  return text.size() == 2 * sizeof(Sha256) && std::ranges::all_of(text, is_digit);
}

// Of what the policy was told and shown. A picture that it failed at is in no step of the trace,
// and which pixels left for a server is in the row alone.
std::string wrong_hash(const ResultRow& row, const Trace& trace) {
  const auto not_of = [](const char* column, const char* what) {
    return std::string("its result row's `") + column + "` is not that of " + what;
  };
  const auto no_hash = [](const char* column) {
    return std::string("its result row's `") + column + "` is no hash";
  };
  const std::string& prompt = trace.header.prompt;
  if (row.prompt_sha256 != to_hex(sha256(prompt)))
    return not_of("prompt_sha256", "the instruction that this trace was told");
  if (trace.steps.empty()) {
    if (!row.image_sha256.empty() && !is_hash(row.image_sha256)) return no_hash("image_sha256");
    if (!row.frames_sha256.empty()) return not_of("frames_sha256", "the pictures in this trace");
  } else {
    Hasher frames;
    for (const TraceStep& step : trace.steps) frames.hash(step.image_hash);
    if (row.image_sha256 != to_hex(trace.steps.front().image_hash))
      return not_of("image_sha256", "the pictures in this trace");
    if (row.frames_sha256 != to_hex(frames.finish()))
      return not_of("frames_sha256", "the pictures in this trace");
  }
  if (row.sent_prompt_sha256.has_value() != row.sent_image_sha256.has_value()) {
    return "its result row has one of `sent_prompt_sha256` and `sent_image_sha256` without the "
           "other";
  }
  if (!row.sent_prompt_sha256) return "";
  if (!policy::can_be_sent_as(prompt, *row.sent_prompt_sha256))
    return not_of("sent_prompt_sha256", "a text that the instruction can be sent as");
  return is_hash(*row.sent_image_sha256) ? "" : no_hash("sent_image_sha256");
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
  if (std::cmp_not_equal(row.steps, steps)) {
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
  if (std::string wrong = wrong_hash(row, trace); !wrong.empty()) return wrong;
  if (is_judged_so(plan, *task, trace)) return "";
  return "its verdicts are not what its own plan says of its measurements";
}

void add_times(const plan::TaskRecord& task, ResultRow& row) {
  row.idle = static_cast<int>(task.idle);
  row.delay = static_cast<int>(task.delay);
}

// As add_task(), of a trace that was read before.
bool add_known(const plan::Plan& plan, const std::vector<double>& joints, ResultRow& row) {
  const auto index = plan.find_task(row.task);
  // When an instruction changed stands in the trace alone.
  if (!index || !plan::later_of(plan.tables(), *index).empty()) return false;
  const plan::TaskRecord& task = plan.tasks()[*index];
  const auto names = plan::joint_names_of(plan.tables(), plan.scenes()[task.scene]);
  if (!joints.empty() && joints.size() != names.size()) return false;
  add_times(task, row);
  for (std::size_t j = 0; j < joints.size(); ++j) row.joints.push_back({names[j], joints[j]});
  return true;
}

std::string terms_of(const Trace& trace) {
  return trace.header.live ? to_text(*trace.header.live) : "";
}

}  // namespace

void add_task(const plan::Plan& plan, const Trace& trace, ResultRow& row) {
  const plan::TaskRecord& task = plan.tasks()[*plan.find_task(row.task)];
  add_times(task, row);
  if (!trace.header.later.empty()) {
    row.told_at = turns_of(trace);
    for (int& step : *row.told_at) ++step;
  }
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

namespace {

// Some hundred rows at a time: proven side by side, then handed on in their order.
class Prover {
 public:
  Prover(const std::string& dir, const plan::Plan& plan, ProvenRun& run, const RowVisitor& visit,
         const std::string& book)
      : plan_(plan), run_(run), visit_(visit), book_(dir, plan, book) {}

  Status add(ResultRow&& row) {
    constexpr std::size_t kAtOnce = 512;  // more do not stay in a core's cache
    rows_.push_back({std::move(row), {}, {}, {}, false});
    return rows_.size() < kAtOnce ? Status() : hand_on();
  }

  Status end() {
    PROBE_TRY(hand_on());
    book_.keep();
    return {};
  }

 private:
  struct Row {
    ResultRow row;
    std::optional<Failure> wrong;
    policy::LiveFigures live;
    std::optional<ProofKey> key;
    bool is_new = false;
  };

  void prove_one(Row& one, ProofKeys& keys) const {
    // How late answers were is in traces alone.
    if (run_.live_terms.empty()) one.key = keys.of(one.row);
    if (one.key) {
      const std::vector<double>* known = book_.find(*one.key);
      if (known != nullptr && add_known(plan_, *known, one.row)) return;
    }
    const auto trace = prove(plan_, one.row);
    if (!trace) {
      one.wrong = trace.failure();
    } else if (const std::string terms = terms_of(*trace); terms != run_.live_terms) {
      one.wrong =
          Failure{Fault::kTrace,
                  std::string("its world ") +
                      (terms.empty() ? "waited for the policy" : "was " + terms) +
                      ", that of its run " +
                      (run_.live_terms.empty() ? "waits" : "is " + run_.live_terms),
                  one.row.trace};
    } else {
      if (!one.row.invalid) one.live = live_figures(*trace);
      add_task(plan_, *trace, one.row);
      // A change while it was read leaves another stamp.
      one.is_new = one.key && keys.of(one.row) == one.key;
    }
  }

  Status hand_on() {
    std::atomic<std::size_t> next{0};
    const auto work = [&] {
      ProofKeys keys;
      for (std::size_t i = next++; i < rows_.size(); i = next++) prove_one(rows_[i], keys);
    };
    std::vector<std::thread> others;
    const std::size_t cores = std::max(1u, std::thread::hardware_concurrency());
    try {
      for (std::size_t i = 1; i < std::min(cores, rows_.size()); ++i) others.emplace_back(work);
    } catch (const std::system_error&) {  // fewer threads do the same
    }
    work();
    for (std::thread& thread : others) thread.join();
    for (Row& one : rows_) {
      if (one.is_new) {
        std::vector<double> joints;
        for (const JointValue& joint : one.row.joints) joints.push_back(joint.position);
        book_.add(*one.key, std::move(joints));
      }
      if (one.wrong) {
        run_.refused.push_back(to_text(key_of(one.row)) + " is left out: " + to_text(*one.wrong));
        continue;
      }
      run_.live.add(one.live);
      PROBE_TRY(visit_(std::move(one.row)));
    }
    rows_.clear();
    return {};
  }

  const plan::Plan& plan_;
  ProvenRun& run_;
  const RowVisitor& visit_;
  ProofBook book_;
  std::vector<Row> rows_;
};

}  // namespace

Result<ProvenRun> for_each_proven_row(const std::string& dir, const RowVisitor& visit,
                                      const std::string& book) {
  PROBE_ASSIGN(const RunRecord record, read_run_record(dir));
  PROBE_ASSIGN(const plan::Plan plan, open_run_plan(dir));
  ProvenRun run;
  run.live_terms = record.identity.live;
  run.only_success = record.identity.only_success;
  Prover prover(dir, plan, run, visit, book);
  PROBE_TRY(for_each_row(dir, [&](ResultRow&& row) { return prover.add(std::move(row)); }));
  PROBE_TRY(prover.end());
  return run;
}

Result<ProvenResults> read_proven_results(const std::string& dir) {
  std::vector<ResultRow> rows;
  PROBE_ASSIGN(ProvenRun run, for_each_proven_row(dir, [&](ResultRow&& row) -> Status {
    rows.push_back(std::move(row));
    return {};
  }));
  return ProvenResults{std::move(run), std::move(rows)};
}

}  // namespace probe::store
