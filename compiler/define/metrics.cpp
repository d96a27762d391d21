// `metrics`: named expressions with the read-out of each.
#include "compiler/define/metrics.h"

#include <algorithm>

#include "compiler/define/define.h"
#include "compiler/define/expr.h"
#include "compiler/define/record.h"
#include "compiler/names/texts.h"
#include "runtime/plan/readouts.h"

namespace probe::sema {
Metric read_metric(Context& context, const syntax::File& file, const syntax::MetricStmt& stmt) {
  Metric metric;
  metric.name = std::string(stmt.name.text);
  metric.span = stmt.name.span;
  check_name(context.diagnostics, stmt.name);
  metric.readout = stmt.readout.kind;
  metric.readout_span = stmt.readout.span;
  ExprReader reader(context, file);
  const bool takes_truth = plan::info(metric.readout).takes == plan::Kind::kBool;
  metric.expr =
      takes_truth ? reader.condition(stmt.readout.expr) : reader.number(stmt.readout.expr);
  metric.variables = reader.variables();
  metric.type = context.model.exprs.nodes[metric.expr].type;
  if (metric.type.is_angle_between) {
    context.report(Code::P0601, stmt.readout.span,
                   "`angle` stands alone on one side of a comparison");
  }
  return metric;
}

namespace {

// A metric of a copied name is replaced where it stands.
void read_items(Context& context, const Declared<syntax::MetricsDecl>& declared, Metrics& metrics) {
  std::vector<std::string_view> here;
  for (const syntax::MetricStmt& stmt : declared.node->body) {
    Metric metric = read_metric(context, *declared.file, stmt);
    if (std::find(here.begin(), here.end(), stmt.name.text) != here.end()) {
      context.report(Code::P0203, stmt.name.span, "metric `" + metric.name + "` is declared twice");
      continue;
    }
    here.push_back(stmt.name.text);
    const auto known = std::find_if(metrics.items.begin(), metrics.items.end(),
                                    [&](const Metric& old) { return old.name == metric.name; });
    if (known != metrics.items.end()) {
      *known = std::move(metric);
    } else {
      metrics.items.push_back(std::move(metric));
    }
  }
}

}  // namespace

void define_metrics(Context& context) {
  const auto read = [&](const Declared<syntax::MetricsDecl>& declared, Metrics& metrics) {
    read_items(context, declared, metrics);
  };
  const auto complete = [](const Metrics&, bool) {};
  define_records(context, context.symbols.metrics, context.symbols.metrics_decls,
                 context.model.metrics, read, complete);
  // A metric of a predicate that was reported has no meaning either.
  for (Metrics& metrics : context.model.metrics) {
    metrics.broken = metrics.broken || std::any_of(metrics.items.begin(), metrics.items.end(),
                                                   [](const Metric& item) {
                                                     return item.type.kind == TypeKind::kPoison;
                                                   });
  }
}

}  // namespace probe::sema
