// P06xx over finished metrics: what can never become true within the horizon. Types were checked
// when reading.
#include <algorithm>
#include <set>

#include "compiler/check/check.h"
#include "compiler/define/remembered.h"
#include "compiler/define/telling.h"
#include "runtime/plan/limits.h"
#include "runtime/plan/readouts.h"

namespace probe::sema {
namespace {

struct HoldFinder {
  const Model& model;
  std::uint64_t horizon;
  std::vector<ExprRef> too_long;
  std::set<ExprRef> seen = {};  // a predicate that calls another twice is looked at once

  // Bounded: expressions by the parser's depth, calls because predicates do not contain themselves.
  void visit(ExprRef ref) {
    if (!seen.insert(ref).second) return;
    const ExprNode& node = model.exprs.nodes[ref];
    if (node.op == ExprOp::kHold && node.a > horizon) too_long.push_back(ref);
    for (const ExprRef arg : node.args) visit(arg);
    if (node.op == ExprOp::kCall) visit(model.predicates[node.predicate].body);
  }
};

// Where a metric asks for fingers or for a gripper: P1003 with a robot that has none.
struct FingerFinder {
  const Model& model;
  const ExprNode* found = nullptr;
  std::string what = {};
  std::set<ExprRef> seen = {};

  void take(const ExprNode& node, std::string words) {
    if (found != nullptr) return;
    found = &node;
    what = std::move(words);
  }
  void visit_set(SetRef ref, const ExprNode& node) {
    const SetNode& set = model.exprs.sets[ref];
    if (set.op == SetOp::kFingers) take(node, "`fingers`");
    for (const ExprRef body : set.bodies) visit(body);
    if (set.op != SetOp::kUnion && set.op != SetOp::kIntersection && set.op != SetOp::kDifference)
      return;
    visit_set(set.left, node);
    visit_set(set.right, node);
  }
  void visit(ExprRef ref) {
    if (found != nullptr || !seen.insert(ref).second) return;
    const ExprNode& node = model.exprs.nodes[ref];
    if (node.op == ExprOp::kMeasure && node.measure == Measure::kGrip) take(node, "`grip`");
    if (node.op == ExprOp::kMeasure && node.measure == Measure::kOpening) take(node, "`opening`");
    if (node.op == ExprOp::kAny || node.op == ExprOp::kAll || node.op == ExprOp::kNo)
      visit_set(node.set, node);
    for (const ExprRef arg : node.args) visit(arg);
    if (node.op == ExprOp::kCall) visit(model.predicates[node.predicate].body);
  }
};

void check_fingers(const Model& model, Reporter& reporter, const Task& task,
                   std::set<std::pair<std::uint32_t, std::uint32_t>>& reported) {
  const Scene& scene = model.scenes[task.scene];
  if (scene.robot == RobotId::kNone) return;
  const Robot& robot = model.robots[scene.robot];
  if (robot.broken || !robot.fingers.empty()) return;
  for (const Metric* metric : measured_in(task)) {
    FingerFinder finder{model};
    finder.visit(metric->expr);
    if (finder.found == nullptr) continue;
    if (!reported.insert({metric->span.file.value, metric->span.begin}).second) continue;
    Diagnostic& said = report_of(
        reporter, Situation::kFingersAskedFor, task, metric->span,
        "metric `" + metric->name + "` asks for fingers, which `" + robot.name + "` has not");
    said.label(finder.found->span, "by " + finder.what).label(task.span, "judged by it");
    said.help("`links` are all parts of a robot; judge `" + task.name +
              "` by metrics that need no gripper");
  }
}

// P0605: read-outs that mean something else than they seem to.
struct LatchLint {
  const Model& model;
  Reporter& reporter;

  const ExprNode& node(ExprRef ref) const { return model.exprs.nodes[ref]; }

  // A comparison of contact impulses, which come and go within a step.
  bool is_pulse(ExprRef ref) const {
    const ExprNode& at = node(ref);
    switch (at.op) {
      case ExprOp::kLess:
      case ExprOp::kLessEqual:
        return std::any_of(at.args.begin(), at.args.end(), [&](ExprRef arg) {
          const ExprNode& side = node(arg);
          return side.op == ExprOp::kMeasure && side.measure == Measure::kImpulse;
        });
      case ExprOp::kAny:
        return is_pulse(at.args[0]);
      case ExprOp::kCall:
        return is_pulse(model.predicates[at.predicate].body);
      default:
        return false;
    }
  }

  void check(const Metric& metric) const {
    const ExprNode& top = node(metric.expr);
    const std::string name = "metric `" + metric.name + "`";
    const bool once = metric.readout == plan::Readout::kOnce;
    if (metric.readout == plan::Readout::kAtEnd && is_pulse(metric.expr)) {
      reporter
          .report(Code::P0605, metric.readout_span, name + " reads a contact at the last step only")
          .help("a contact comes and goes: `once` keeps it");
    } else if (once && top.op == ExprOp::kNot && node(top.args[0]).span != top.span) {  // not `!=`
      reporter
          .report(Code::P0605, metric.readout_span,
                  name + " is true as soon as one step lacks its condition")
          .help("for a condition that never holds write `always not`");
    } else if ((once || metric.readout == plan::Readout::kAlways) &&
               (top.op == ExprOp::kOnce || top.op == ExprOp::kAlways)) {
      reporter.report(Code::P0605, metric.readout_span, name + " latches what is latched already")
          .help("one latch is enough: with `at end`, the inner one is read at the last step");
    }
  }
};

}  // namespace

std::string words_of_truths() {
  std::vector<std::string> words;
  for (const plan::ReadoutInfo& info : plan::kReadoutTable) {
    if (info.is_truth()) words.push_back("`" + std::string(info.words) + "`");
  }
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i)
    text += (i == 0 ? "" : i + 1 < words.size() ? ", " : " or ") + words[i];
  return text;
}

namespace {

// `success` is what an episode is scored by: a condition, in every task.
void check_success(const Model& model, Reporter& reporter, const Task& task,
                   std::set<std::pair<std::uint32_t, std::uint32_t>>& reported) {
  const auto success = std::find_if(task.judged.begin(), task.judged.end(),
                                    [](const Metric& metric) { return metric.name == "success"; });
  // What a copy lacks, the original lacks.
  MetricsId id = task.metrics;
  const auto lacks_success = [&](MetricsId at) {
    const auto& items = model.metrics[at].items;
    return std::none_of(items.begin(), items.end(),
                        [](const Metric& metric) { return metric.name == "success"; });
  };
  for (MetricsId like = model.metrics[id].like; like != MetricsId::kNone;
       like = model.metrics[like].like) {
    if (lacks_success(like)) id = like;
  }
  const Metrics& metrics = model.metrics[id];
  const Span& place = success == task.judged.end() ? metrics.span : success->span;
  const bool is_condition = success != task.judged.end() && plan::info(success->readout).is_truth();
  if (is_condition || !reported.insert({place.file.value, place.begin}).second) return;
  if (success == task.judged.end()) {
    reporter
        .report(Situation::kNoSuccess, place, "metrics `" + metrics.name + "` have no `success`")
        .label(task.span, "judged by them")
        .help("an episode is scored by `success = at end ...`");
  } else {
    reporter.report(Code::P0601, success->readout_span, "expected `success` to be true or false")
        .help("an episode is scored by it: " + words_of_truths() + " a condition");
  }
}

void check_count(const Model& model, Reporter& reporter, const Task& task,
                 std::set<std::pair<std::uint32_t, std::uint32_t>>& reported) {
  if (task.judged.size() <= plan::kMaxMetrics) return;
  const Span& place = model.metrics[task.metrics].span;
  if (!reported.insert({place.file.value, place.begin}).second) return;
  reporter
      .report(Situation::kTooManyMetrics, place,
              "expected at most " + std::to_string(plan::kMaxMetrics) +
                  " metrics of a task, found " + std::to_string(task.judged.size()))
      .label(task.span, "judged by them");
}

}  // namespace

std::string asks_for_fingers(const Model& model, ExprRef expr) {
  FingerFinder finder{model};
  finder.visit(expr);
  return finder.what;
}

void check_metrics(const Model& model, Reporter& reporter) {
  // A metric that is copied with `like` is looked at where it stands.
  std::set<std::pair<std::uint32_t, std::uint32_t>> looked_at;
  const auto lint = [&](const Metric& metric) {
    if (looked_at.insert({metric.span.file.value, metric.span.begin}).second)
      LatchLint{model, reporter}.check(metric);
  };
  for (const Metrics& metrics : model.metrics) {
    for (const Metric& metric : metrics.items) lint(metric);
  }
  for (const Task& task : model.tasks) {
    for (const Metric& metric : task.overrides) lint(metric);
  }
  std::set<std::pair<ExprRef, std::uint64_t>> searched, reported;  // with the horizon
  std::set<std::pair<std::uint32_t, std::uint32_t>> without_success, without_fingers;
  Silence silence(model, reporter, Silent::kMetrics, Silence::Says::kOnce);
  for (const Task& task : model.tasks) {
    if (task.abstract || !task.complete || silence.is_known(task)) continue;
    const About about(reporter, task.decl_span);
    check_success(model, reporter, task, without_success);
    check_count(model, reporter, task, without_success);
    check_fingers(model, reporter, task, without_fingers);
    for (const Metric* metric : measured_in(task)) {
      if (!searched.insert({metric->expr, task.horizon}).second) continue;
      HoldFinder finder{model, task.horizon, {}};
      finder.visit(metric->expr);
      for (const ExprRef hold : finder.too_long) {
        if (!reported.insert({hold, task.horizon}).second) continue;
        report_of(reporter, Code::P0604, task, model.exprs.nodes[hold].span,
                  "metric `" + metric->name + "` can never become true in `" + task.name + "`")
            .point("the horizon is " + std::to_string(task.horizon) + " steps")
            .label(task.horizon_span, "set here");
      }
    }
  }
}

}  // namespace probe::sema
