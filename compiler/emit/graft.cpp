#include "compiler/emit/graft.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>
#include <set>

#include "compiler/check/check.h"
#include "compiler/emit/merged_program.h"
#include "compiler/emit/plan_bodies.h"
#include "compiler/lower/lower.h"
#include "runtime/plan/readouts.h"
#include "runtime/plan/writer.h"

namespace probe {
namespace {

bool is_of_root(const AnalyzedText& text, const Span& span) {
  return !span.is_none() && text.root_files.contains(span.file.value);
}

// Whether something is measured from a camera or from the robot's base.
struct FrameFinder {
  const sema::Model& model;
  std::set<sema::ExprRef> seen = {};

  bool reads_set(sema::SetRef ref) {
    using sema::SetOp;
    const sema::SetNode& set = model.exprs.sets[ref];
    if (std::ranges::any_of(set.bodies, [&](sema::ExprRef body) { return reads(body); }))
      return true;
    const bool is_pair =
        set.op == SetOp::kUnion || set.op == SetOp::kIntersection || set.op == SetOp::kDifference;
    return is_pair && (reads_set(set.left) || reads_set(set.right));
  }
  bool reads(sema::ExprRef ref) {
    using sema::ExprOp;
    if (!seen.insert(ref).second) return false;
    const sema::ExprNode& node = model.exprs.nodes[ref];
    if (node.op == ExprOp::kMeasure && sema::is_of_frame(node.measure)) return true;
    const bool has_set =
        node.op == ExprOp::kAny || node.op == ExprOp::kAll || node.op == ExprOp::kNo;
    return (has_set && reads_set(node.set)) ||
           std::ranges::any_of(node.args, [&](sema::ExprRef arg) { return reads(arg); }) ||
           (node.op == ExprOp::kCall && reads(model.predicates[node.predicate].body));
  }
};

class Graft {
 public:
  Graft(const plan::Plan& stored, AnalyzedText text)
      : stored_(stored), text_(std::move(text)), bodies_(stored, text_.model) {}

  Result<Grafted> run() {
    PROBE_TRY(choose());
    plan::Records& records = writer_.records;
#define PROBE_SECTION(kind, name, tag, Record, member, may_be_ignored) \
  records.member.assign(stored_.member().begin(), stored_.member().end());
#include "runtime/plan/sections.def"
    keep_sources();
    for (std::uint32_t t = 0; t < stored_.tasks().size(); ++t) {
      PROBE_ASSIGN(records.tasks[t].program, program_of(t));
    }
    for (const MetricLeftOut& out : left_out_) {
      if (out.tasks.size() == stored_.tasks().size()) ++nowhere_;
    }
    if (nowhere_ == metrics_.size()) {
      return Failure{Fault::kUsage,
                     fmt::format("metric `{}` fits no task of the plan: {}",
                                 left_out_.front().metric, left_out_.front().tasks.front().why),
                     text_.compilation.sources.file(metrics_.front().span.file).name()};
    }
    Grafted out;
    PROBE_ASSIGN(out.plan, writer_.finish());
    for (const sema::Metric& metric : metrics_) out.metrics.push_back(metric.name);
    out.left_out = std::move(left_out_);
    return out;
  }

 private:
  Status choose() {
    for (const sema::Metrics& set : text_.model.metrics) {
      if (!is_of_root(text_, set.span)) continue;
      for (const sema::Metric& metric : set.items) {
        const auto known = std::ranges::find(metrics_, metric.name, &sema::Metric::name);
        if (known == metrics_.end()) {
          if (metric.name == "success" && !plan::info(metric.readout).is_truth()) {
            return refuse(metric, "has to be true or false, as an episode is scored by it: " +
                                      sema::words_of_truths() + " a condition (P0601)");
          }
          metrics_.push_back(metric);
        } else if (known->span != metric.span) {  // the same one comes with `like`
          return refuse(metric, "stands for two metrics of this text");
        }
      }
    }
    if (metrics_.empty()) return Failure{Fault::kUsage, "the text declares no metrics", ""};
    for (const sema::Metric& metric : metrics_) {
      if (!FrameFinder{text_.model}.reads(metric.expr)) continue;
      return refuse(metric,
                    "measures from a camera or robot (`view_x`, `robot_x`), which only the plan's "
                    "own text knows");
    }
    return {};
  }

  Failure refuse(const sema::Metric& metric, const std::string& why) const {
    const SourceFile& file = text_.compilation.sources.file(metric.span.file);
    return {Fault::kUsage, "metric `" + metric.name + "` " + why,
            fmt::format("{}:{}", file.name(), file.line_of(metric.span.begin))};
  }

  // The texts that metrics stand in, for explanations.
  void keep_sources() {
    const SourceSet& sources = text_.compilation.sources;
    for (std::uint32_t i = 0; i < sources.size(); ++i) {
      const SourceFile& file = sources.file(FileId{i});
      const std::string name = std::filesystem::path(file.name()).filename().string();
      source_of_.push_back(writer_.source(name, file.text()));
    }
  }

  // The program by which the task is judged from now on.
  Result<std::uint32_t> program_of(std::uint32_t index) {
    const plan::TaskRecord& task = stored_.tasks()[index];
    const std::vector<lower::Body> bodies = bodies_.of(task);
    const bool has_fingers =
        plan::finger_count(stored_.robots()[stored_.scenes()[task.scene].robot]) > 0;
    std::vector<std::uint32_t> shape = lower::shape_of(text_.model, metrics_, bodies);
    shape.push_back(task.program);
    shape.push_back(has_fingers ? 1 : 0);
    const auto known = programs_.find(shape);
    if (known != programs_.end()) {
      for (const auto& [metric, why] : misses_[known->second]) leave_out(metric, index, why);
      return known->second;
    }
    std::vector<sema::Metric> fitting;
    std::vector<std::pair<std::string, std::string>> misses;
    for (const sema::Metric& metric : metrics_) {
      const std::string why = why_not(metric, bodies, has_fingers);
      if (why.empty()) {
        fitting.push_back(metric);
      } else {
        misses.emplace_back(metric.name, why);
        leave_out(metric.name, index, why);
      }
    }
    Diagnostics unheard;
    auto program = lower::lower_metrics(text_.model, fitting, bodies, {}, unheard);
    if (!program) {
      return Failure{Fault::kUsage, unheard.items().front().message,
                     std::string(stored_.text(task.name))};
    }
    PROBE_ASSIGN(const std::uint32_t made,
                 emit::merge_program(writer_, stored_.programs()[task.program], *program,
                                     source_of_, stored_.text(task.name)));
    programs_.emplace(std::move(shape), made);
    misses_.emplace(made, std::move(misses));
    return made;
  }

  // Why the metric cannot be measured there; empty when it can.
  std::string why_not(const sema::Metric& metric, const std::vector<lower::Body>& bodies,
                      bool has_fingers) const {
    if (!has_fingers) {
      const std::string asked = sema::asks_for_fingers(text_.model, metric.expr);
      if (!asked.empty()) return "the robot has no fingers, " + asked + " is asked for";
    }
    Diagnostics said;
    const auto program = lower::lower_metrics(text_.model, std::span(&metric, 1), bodies, {}, said);
    if (program) return {};
    const Diagnostic& first = said.items().front();
    return fmt::format("{} (`{}`)", first.message, text_.compilation.sources.text(first.primary));
  }

  void leave_out(const std::string& metric, std::uint32_t task, const std::string& why) {
    auto known = std::ranges::find(left_out_, metric, &MetricLeftOut::metric);
    if (known == left_out_.end()) known = left_out_.insert(known, {metric, {}});
    known->tasks.push_back({std::string(stored_.text(stored_.tasks()[task].name)), why});
  }

  const plan::Plan& stored_;
  AnalyzedText text_;
  emit::PlanBodies bodies_;
  plan::Writer writer_;
  std::vector<sema::Metric> metrics_;
  std::vector<std::uint32_t> source_of_;  // by FileId: kTexts
  std::map<std::vector<std::uint32_t>, std::uint32_t> programs_;
  std::map<std::uint32_t, std::vector<std::pair<std::string, std::string>>> misses_;  // by program
  std::vector<MetricLeftOut> left_out_;
  std::size_t nowhere_ = 0;
};

}  // namespace

bool is_metrics_alone(const AnalyzedText& text) {
  const bool has_task = std::ranges::any_of(text.model.tasks, [&](const sema::Task& task) {
    return !task.abstract && is_of_root(text, task.span);
  });
  return !has_task && text.compilation.own_suites.empty() && !declared_metrics(text).empty();
}

std::vector<DeclaredMetrics> declared_metrics(const AnalyzedText& text) {
  std::vector<DeclaredMetrics> out;
  for (const sema::Metrics& set : text.model.metrics) {
    if (!is_of_root(text, set.span)) continue;
    DeclaredMetrics& declared = out.emplace_back();
    declared.name = set.name;
    for (const sema::Metric& metric : set.items) declared.metrics.push_back(metric.name);
  }
  return out;
}

Result<Grafted> graft_metrics(const plan::Plan& stored, AnalyzedText text) {
  return Graft(stored, std::move(text)).run();
}

}  // namespace probe
