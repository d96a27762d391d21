// P06xx over finished metrics: what can never become true within the horizon. Types were checked
// when reading.
#include <set>

#include "compiler/sema/passes.h"

namespace probe::sema {
namespace {

struct HoldFinder {
  const Model& model;
  std::uint64_t horizon;
  std::vector<ExprRef> too_long;

  // Bounded: expressions by the parser's depth, calls because predicates do not contain themselves.
  void visit(ExprRef ref) {
    const ExprNode& node = model.exprs.nodes[ref];
    if (node.op == ExprOp::kHold && node.a > horizon) too_long.push_back(ref);
    for (const ExprRef arg : node.args) visit(arg);
    if (node.op == ExprOp::kCall) visit(model.predicates[node.predicate].body);
  }
};

}  // namespace

void check_metrics(Context& context) {
  std::set<std::pair<ExprRef, std::uint64_t>> reported;
  for (const Task& task : context.model.tasks) {
    if (task.abstract || !task.complete) continue;
    const About about(context, task.decl_span);
    for (const Metric& metric : task.judged) {
      HoldFinder finder{context.model, task.horizon, {}};
      finder.visit(metric.expr);
      for (const ExprRef hold : finder.too_long) {
        if (!reported.insert({hold, task.horizon}).second) continue;
        context
            .report(Code::P0604, context.model.exprs.nodes[hold].span,
                    "metric `" + metric.name + "` can never become true in `" + task.name + "`")
            .point("the horizon is " + std::to_string(task.horizon) + " steps")
            .label(task.horizon_span, "set here");
      }
    }
  }
}

}  // namespace probe::sema
