#include "runtime/rejudge/explain.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "runtime/base/trig.h"
#include "runtime/plan/readouts.h"
#include "runtime/plan/source_line.h"
#include "runtime/rejudge/dimension.h"
#include "runtime/rejudge/program_view.h"
#include "runtime/rejudge/rescore.h"
#include "runtime/store/run_plan.h"
#include "runtime/store/store.h"
#include "runtime/store/stored_trace.h"
#include "runtime/vm/claims.h"

namespace probe::rejudge {
namespace {

using plan::Op;

// More comparisons of one text than this are a quantifier over many bodies: then only those that
// decide are listed, up to as many.
constexpr std::size_t kFew = 3;

// What happened to the predicate of one metric over the episode. Steps are one-based, 0 is none.
struct History {
  std::uint16_t core = 0;  // the register under the outermost monitor, or what is emitted
  // What that monitor is the read-out of; kFinal for none.
  plan::Readout kept = plan::Readout::kFinal;
  bool is_truth = true;  // the core's type
  int first_true = 0, last_true = 0, first_false = 0;
  int changed = 0;  // since when the core is what it is
  int nearest = 0;  // at which it came nearest to being true, the last of these
  std::uint32_t distance = 0;
  double gap = 0;  // by how much the one comparison that it then lacked was missed
  int best = 0;    // at which the emitted value became what it is
  double core_value = 0, value = 0;
};

History history_of(const ProgramView& view, std::uint32_t metric) {
  History h;
  h.core = view.emitted(metric);
  if (const plan::ReadoutInfo* readout = plan::readout_of(view.op(h.core))) {
    h.kept = readout->readout;
    h.core = view.at(h.core).a;
  }
  h.is_truth = plan::find_op(view.at(h.core).op)->result == plan::Kind::kBool;
  return h;
}

void note(History& h, int step, double core, double value, std::uint32_t distance, double gap) {
  if (core != 0) {
    if (h.first_true == 0) h.first_true = step;
    h.last_true = step;
  } else if (h.first_false == 0) {
    h.first_false = step;
  }
  if (step == 1 || core != h.core_value) h.changed = step;
  if (step == 1 || value != h.value) h.best = step;
  if (step == 1 || std::pair(distance, gap) <= std::pair(h.distance, h.gap)) {
    h.nearest = step;
    h.distance = distance;
    h.gap = gap;
  }
  h.core_value = core;
  h.value = value;
}

// The rest of a one-line statement from `begin` on: `highest = max height(o)`.
std::string statement_at(std::string_view source, std::size_t begin) {
  std::size_t end = begin;
  for (int depth = 0; end < source.size(); ++end) {
    const char c = source[end];
    depth += c == '{' ? 1 : (c == '}' ? -1 : 0);
    if (depth < 0 || c == '\n' || c == '\r' || c == ';' || c == '#') break;
  }
  while (end > begin && source[end - 1] == ' ') --end;
  return std::string(source.substr(begin, end - begin));
}

// The step that decides and how to say so.
std::pair<int, std::string> decision(const History& h, int last) {
  if (last == 0) return {0, "no step was made"};
  const auto never = [&]() -> std::pair<int, std::string> {
    return {h.nearest, fmt::format("never, nearest at step {}", h.nearest)};
  };
  switch (h.kept) {
    case plan::Readout::kOnce:
      if (h.first_true == 0) return never();
      return {h.first_true, fmt::format("since step {}", h.first_true)};
    case plan::Readout::kAlways:
      if (h.first_false == 0) return {last, fmt::format("at each of {} steps", last)};
      return {h.first_false, fmt::format("broken at step {}", h.first_false)};
    case plan::Readout::kFirst:
      if (h.first_true == 0) return never();
      return {h.first_true, fmt::format("at step {}", h.first_true)};
    case plan::Readout::kCount:
      if (h.last_true == 0) return never();
      return {h.last_true, fmt::format("last at step {} of {}", h.last_true, last)};
    case plan::Readout::kTimes:
      if (h.first_true == 0) return never();
      return {h.best, fmt::format("last from step {}", h.best)};
    case plan::Readout::kMax:
    case plan::Readout::kMin:
      return {h.best, fmt::format("at step {}", h.best)};
    case plan::Readout::kAtEnd:
    case plan::Readout::kFinal:
    case plan::Readout::kEnds:
      break;
  }
  if (!h.is_truth || h.changed == last) return {last, fmt::format("at step {}", last)};
  return {last, fmt::format("at step {}, since step {}", last, h.changed)};
}

class Explainer {
 public:
  Explainer(const plan::Plan& plan, std::uint32_t task)
      : plan_(plan),
        task_(plan.tasks()[task]),
        program_(plan.programs()[task_.program]),
        view_(plan, task_),
        dimensions_(dimensions_of(plan, program_)),
        judge_(plan, task),
        run_lengths_(view_.registers()),
        since_(view_.registers()),
        was_(view_.registers()) {}

  Result<std::vector<MetricWhy>> run(const store::Trace& trace,
                                     std::span<const std::uint32_t> chosen, std::size_t steps) {
    std::vector<History> histories;
    std::vector<std::vector<std::uint16_t>> conditions;
    for (const std::uint32_t m : chosen) {
      histories.push_back(history_of(view_, m));
      conditions.push_back(view_.conditions(histories.back().core));
    }
    PROBE_TRY(judge_.begin(trace.start->starts));
    for (std::size_t i = 0; i < steps; ++i) {
      PROBE_TRY(judge_.step(trace.steps[i].sample));
      count_runs(static_cast<int>(i) + 1);
      const auto distances = view_.distances(judge_, run_lengths_);
      for (std::size_t k = 0; k < chosen.size(); ++k) {
        History& h = histories[k];
        note(h, static_cast<int>(i) + 1, judge_.register_value(h.core).x(), judge_.value(chosen[k]),
             distances[h.core], missed_by(conditions[k]));
      }
    }
    std::vector<MetricWhy> out;
    for (std::size_t k = 0; k < chosen.size(); ++k) {
      out.push_back(summary(chosen[k], histories[k], static_cast<int>(steps)));
    }
    // Once more, because registers are only known while the judge stands at their step.
    PROBE_TRY(judge_.begin(trace.start->starts));
    std::ranges::fill(run_lengths_, 0);
    for (std::size_t i = 0; i < steps; ++i) {
      PROBE_TRY(judge_.step(trace.steps[i].sample));
      count_runs(static_cast<int>(i) + 1);
      for (std::size_t k = 0; k < chosen.size(); ++k) {
        if (out[k].step == static_cast<int>(i) + 1) describe(chosen[k], histories[k], out[k]);
      }
    }
    return out;
  }

 private:
  MetricWhy summary(std::uint32_t metric, const History& h, int steps) const {
    const plan::MetricRecord& record = plan_.metrics(program_)[metric];
    MetricWhy why;
    why.name = plan_.text(record.name);
    why.is_bool = record.type == static_cast<std::uint32_t>(plan::MetricType::kBool);
    why.value = h.value;
    why.shown = why.is_bool ? (h.value != 0 ? "true" : "false")
                            : quantity(h.value, metric_dimensions(plan_, program_)[metric]);
    why.readout = plan::find_readout(record.readout)->words;
    std::tie(why.step, why.when) = decision(h, steps);
    if (const auto* span =
            plan_.span_of(plan::SpanKind::kMetrics, program_.metrics.first + metric)) {
      const plan::TextRecord& text = plan_.texts()[span->text];
      const auto line = plan::line_at(plan_.tables().source(text), span->begin);
      why.file = plan_.tables().path(text);
      why.line = line.number;
      why.text = line.text;
      why.statement = statement_at(plan_.tables().source(text), span->begin);
    }
    return why;
  }

  // How far the only comparison that does not hold is from holding; infinite where there are more,
  // or none.
  double missed_by(std::span<const std::uint16_t> conditions) const {
    double gap = std::numeric_limits<double>::infinity();
    for (const std::uint16_t reg : conditions) {
      const bool compares = view_.op(reg) == Op::kLT || view_.op(reg) == Op::kLE;
      if (!compares || judge_.register_value(reg).x() != 0) continue;
      if (std::isfinite(gap)) return std::numeric_limits<double>::infinity();
      const plan::Instruction& in = view_.at(reg);
      gap = std::fabs(judge_.register_value(in.a).x() - judge_.register_value(in.b).x());
    }
    return gap;
  }

  // For how many steps the operand of each HOLD has been true, and since when what is kept is so.
  void count_runs(int step) {
    for (std::size_t r = 0; r < run_lengths_.size(); ++r) {
      const auto reg = static_cast<std::uint16_t>(r);
      if (view_.is_kept(reg)) {
        const bool now = judge_.register_value(reg).x() != 0;
        if (step == 1 || now != was_[r]) since_[r] = step;
        was_[r] = now;
      }
      if (view_.op(reg) != Op::kHOLD) continue;
      const bool truth = judge_.register_value(view_.at(reg).a).x() != 0;
      run_lengths_[r] = truth ? run_lengths_[r] + 1 : 0;
    }
  }

  void describe(std::uint32_t metric, const History& h, MetricWhy& why) const {
    if (!h.is_truth) {
      Condition value;
      view_.locate(h.core, metric, value);
      value.bodies = view_.bodies(h.core, false);
      value.measured = quantity(judge_.register_value(h.core).x(), dimensions_[h.core]);
      value.is_number = true;
      // Where the metric is declared: equal numbers of several metrics are computed once, at the
      // first one's place.
      if (!why.file.empty()) {
        value.file = why.file;
        value.line = why.line;
        value.text = why.statement;
      }
      why.conditions.push_back(std::move(value));
      return;
    }
    const auto regs = view_.conditions(h.core);
    const auto deciding = view_.deciding(h.core, judge_);
    std::vector<Condition> all;
    for (const std::uint16_t reg : regs) all.push_back(condition(reg, metric));
    const auto same_text = [](const Condition& a, const Condition& b) {
      return a.line == b.line && a.file == b.file && a.text == b.text;
    };
    for (std::size_t i = 0; i < all.size(); ++i) {
      std::size_t copies = 0, listed = 0;
      for (const Condition& other : all) copies += same_text(other, all[i]) ? 1 : 0;
      all[i].decides = deciding[regs[i]];
      Condition* twin = nullptr;
      for (Condition& other : why.conditions) {
        if (!same_text(other, all[i])) continue;
        ++listed;
        if (other.truth == all[i].truth) twin = &other;
      }
      const bool is_one_of_many = copies > kFew && (!deciding[regs[i]] || listed >= kFew);
      if (is_one_of_many && twin != nullptr) {
        ++twin->alike;
        continue;
      }
      why.conditions.push_back(all[i]);
    }
  }

  Condition condition(std::uint16_t reg, std::uint32_t metric) const {
    Condition c;
    view_.locate(reg, metric, c);
    const std::uint16_t compared = view_.op(reg) == Op::kHOLD ? view_.at(reg).a : reg;
    const bool is_comparison = view_.op(compared) == Op::kLT || view_.op(compared) == Op::kLE;
    const bool swapped = is_comparison && c.text.find('>') != std::string::npos;
    c.bodies = view_.bodies(compared, swapped);
    c.truth = judge_.register_value(reg).x() != 0;
    const plan::Instruction& in = view_.at(reg);
    if (view_.op(reg) == Op::kHOLD) {
      c.measured = fmt::format("{} of {} steps", std::min<int>(run_lengths_[reg], view_.hold(reg)),
                               view_.hold(reg));
      return c;
    }
    if (view_.is_kept(reg)) {
      const bool once = view_.op(reg) == Op::kONCE;
      c.measured = once == c.truth
                       ? fmt::format("{} step {}", once ? "since" : "broken at", since_[reg])
                       : (once ? "never" : "at each step");
      return c;
    }
    if (const auto angle = angle_condition(in)) {
      c.measured = *angle;
      return c;
    }
    // The judge knows < and <= alone; people read the comparison as it was written.
    const bool is_strict = view_.op(reg) == Op::kLT;
    const Dimension dimension =
        dimensions_[in.a] == Dimension::kAny ? dimensions_[in.b] : dimensions_[in.a];
    auto [left, right] =
        quantities(judge_.register_value(in.a).x(), judge_.register_value(in.b).x(), dimension);
    if (swapped) std::swap(left, right);
    c.measured =
        left + (swapped ? (is_strict ? " > " : " >= ") : (is_strict ? " < " : " <= ")) + right;
    return c;
  }

  // cos A |u| |v| <= u . v is how `angle(u, v) <= A` is computed; said in degrees again.
  std::optional<std::string> angle_condition(const plan::Instruction& in) const {
    const bool dot_right = view_.op(in.b) == Op::kVDOT;
    const std::uint16_t dot = dot_right ? in.b : in.a, edge = dot_right ? in.a : in.b;
    if (view_.op(dot) != Op::kVDOT || view_.op(edge) != Op::kMUL) return std::nullopt;
    const plan::Instruction& outer = view_.at(edge);
    if (view_.op(outer.a) != Op::kMUL || view_.op(outer.b) != Op::kVLEN) return std::nullopt;
    const plan::Instruction& inner = view_.at(outer.a);
    if (view_.op(inner.a) != Op::kKR || view_.op(inner.b) != Op::kVLEN) return std::nullopt;
    const bool is_pair =
        view_.at(inner.b).a == view_.at(dot).a && view_.at(outer.b).a == view_.at(dot).b;
    if (!is_pair) return std::nullopt;
    const bool is_strict = static_cast<Op>(in.op) == Op::kLT;
    const double lengths = judge_.register_value(inner.b).x() * judge_.register_value(outer.b).x();
    const double limit = portable_acos(judge_.register_value(inner.a).x());
    const char* relation = dot_right ? (is_strict ? "<" : "<=") : (is_strict ? ">" : ">=");
    if (!(lengths > 0)) {
      // Of a zero vector: both sides of the comparison are 0.
      return fmt::format("zero vector, {} angle {} {}", is_strict ? "no" : "any", relation,
                         angle_text(limit));
    }
    const double cosine = std::clamp(judge_.register_value(dot).x() / lengths, -1.0, 1.0);
    return fmt::format("{} {} {}", angle_text(portable_acos(cosine)), relation, angle_text(limit));
  }

  const plan::Plan& plan_;
  const plan::TaskRecord& task_;
  const plan::ProgramRecord& program_;
  ProgramView view_;
  std::vector<Dimension> dimensions_;
  vm::Judge judge_;
  std::vector<int> run_lengths_;
  std::vector<int> since_;  // of `once` and `always` inside conditions
  std::vector<bool> was_;
};

}  // namespace

Result<std::vector<MetricWhy>> explain(const plan::Plan& plan, std::uint32_t task,
                                       const store::Trace& trace, const std::string& metric) {
  PROBE_ASSIGN(const Rescored score, rescore(plan, task, trace));
  const plan::TaskRecord& record = plan.tasks()[task];
  std::vector<std::uint32_t> chosen;
  std::string known;
  for (std::uint32_t m = 0; m < plan.metrics(record).size(); ++m) {
    const std::string_view name = plan.text(plan.metrics(record)[m].name);
    known += (known.empty() ? "" : ", ") + std::string(name);
    if (metric.empty() || name == metric) chosen.push_back(m);
  }
  if (chosen.empty() && !metric.empty()) {
    return Failure{
        Fault::kUsage,
        "task `" + trace.header.task + "` has no metric `" + metric + "`; it has " + known, ""};
  }
  if (!trace.start) return std::vector<MetricWhy>();
  return Explainer(plan, task).run(trace, chosen, score.steps.size());
}

namespace {

Result<std::vector<ClaimWhy>> explain_claims(const plan::Plan& plan, std::uint32_t task,
                                             const store::TraceStart& start) {
  PROBE_ASSIGN(const auto verdicts, vm::judge_claims(plan, task, start.starts, start.sample));
  const auto bodies = plan.bodies(plan.tasks()[task]);
  std::vector<ClaimWhy> out;
  for (const vm::ClaimVerdict& claim : verdicts) {
    ClaimWhy why{
        std::string(claim.text), std::string(plan.text(bodies[claim.body].name)), {}, claim.holds};
    for (const std::uint32_t body : claim.denoted)
      why.denoted.emplace_back(plan.text(bodies[body].name));
    out.push_back(std::move(why));
  }
  return out;
}

}  // namespace

Result<EpisodeWhy> why(const std::string& dir, const std::string& task, int episode,
                       std::optional<int> seed, const std::string& metric) {
  PROBE_ASSIGN(const plan::Plan plan, store::open_run_plan(dir));
  // Names with a suite's prefix are understood here too.
  const auto index = plan.find_task(task);
  const std::string name(index ? plan.text(plan.tasks()[*index].name) : std::string_view(task));
  PROBE_ASSIGN(const store::StoredTrace stored, store::find_trace(dir, name, episode, seed));
  if (!index || stored.trace.header.plan_root != plan.root()) {
    return Failure{Fault::kStore, "its plan is not the one of its traces", store::plan_path(dir)};
  }
  EpisodeWhy out{.task = name,
                 .episode = episode,
                 .seed = stored.row.seed,
                 .steps = static_cast<int>(stored.trace.steps.size()),
                 .invalid = stored.row.invalid,
                 .remark = stored.row.remark,
                 .claims = {},
                 .metrics = {}};
  if (stored.trace.start) {
    PROBE_ASSIGN(out.claims, explain_claims(plan, *index, *stored.trace.start));
  }
  PROBE_ASSIGN(out.metrics, explain(plan, *index, stored.trace, metric));
  return out;
}

}  // namespace probe::rejudge
