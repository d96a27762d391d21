#include "compiler/lower/lower.h"

#include "compiler/lower/lowering.h"
#include "runtime/plan/claims.h"
#include "runtime/plan/readouts.h"

namespace probe::lower {

bool Lowering::metric(const sema::Metric& metric) {
  variables_.assign(metric.variables, Value{});
  empty_.clear();
  Value value = eval(metric.expr);
  builder_.at(metric.readout_span);
  ProgramMetric record{metric.name, plan::MetricType::kBool, metric.readout, metric.span, empty_};
  const plan::ReadoutInfo& readout = plan::info(metric.readout);
  if (readout.has_monitor()) value = builder_.monitor(readout.monitor, value);
  record.type = readout.is_truth() ? plan::MetricType::kBool : plan::MetricType::kReal;
  builder_.emit_metric(value, std::move(record));
  if (builder_.is_full() && ok_) {
    diagnostics_.report(Code::P0601, metric.span,
                        "the metrics of this task need more than 4096 instructions");
    ok_ = false;
  }
  return ok_;
}

bool Lowering::relation(const sema::Predicate& relation, std::span<const std::uint16_t> of,
                        const Bodies& alike) {
  const Value value = related(relation, of, alike);
  builder_.at(relation.span);
  builder_.emit_metric(
      value, {relation.name, plan::MetricType::kBool, plan::Readout::kAtEnd, relation.span});
  return ok_ && !builder_.is_full();
}

bool Lowering::claimed(const ClaimedBody& claimed) {
  Value all = Value::of_truth(true);
  Span span;
  for (const ClaimedBody::Relation& one : claimed.relations) {
    span = one.relation->span;
    Value holds = Value::of_truth(claimed.is_meant);
    for (const Bodies& alike : one.alike) {
      const Value here = related(*one.relation, one.of, alike);
      builder_.at(span);
      holds =
          claimed.is_meant ? builder_.logical_and(holds, here) : builder_.logical_or(holds, here);
    }
    all = builder_.logical_and(all, holds);
  }
  builder_.at(span);
  builder_.emit_metric(all, {plan::claim_metric(claimed.body), plan::MetricType::kBool,
                             plan::Readout::kAtEnd, span});
  return ok_ && !builder_.is_full();
}

bool Lowering::put(const PutBody& put, const Span& span) {
  builder_.at(span);
  Value holds = Value::of_truth(true);
  const std::uint16_t own = builder_.emit(Op::kPOS, put.body);
  if (put.region != nullptr) {
    const std::uint16_t here = builder_.emit(Op::kLOCAL, put.carrier, own);
    constexpr Op kAxes[] = {Op::kVX, Op::kVY, Op::kVZ};
    for (std::size_t i = 0; i < 3; ++i) {
      const Value at = Value::of_register(builder_.emit(kAxes[i], here));
      const Value low = builder_.less(Value::of_number(put.region->low[i]), at, true);
      holds = builder_.logical_and(holds, low);
      if (i == 2) break;
      const Value high = builder_.less(at, Value::of_number(put.region->high[i]), true);
      holds = builder_.logical_and(holds, high);
    }
  } else {
    const std::uint16_t other = builder_.emit(Op::kPOS, put.carrier);
    const Value apart =
        Value::of_register(builder_.emit(Op::kVLENXY, builder_.emit(Op::kVSUB, own, other)));
    const Value reach =
        Value::of_register(builder_.emit(Op::kVLENXY, builder_.emit(Op::kHALF, put.carrier)));
    holds = builder_.less(apart, reach, true);
    if (!put.in) {
      const Value low = Value::of_register(builder_.emit(Op::kVZ, other));
      const Value high = Value::of_register(builder_.emit(Op::kVZ, own));
      const Value above = builder_.less(low, high, false);
      holds = builder_.logical_and(holds, above);
    }
  }
  builder_.emit_metric(
      holds, {plan::claim_metric(put.body), plan::MetricType::kBool, plan::Readout::kAtEnd, span});
  return ok_ && !builder_.is_full();
}

Value Lowering::related(const sema::Predicate& relation, std::span<const std::uint16_t> of,
                        const Bodies& alike) {
  variables_.assign(relation.variables, Value{});
  for (std::size_t i = 0; i < relation.parameters.size(); ++i)
    variables_[i] =
        i < of.size() ? Value::of_body(of[i]) : eval(relation.parameters[i].default_value);
  alike_ = alike;
  return eval(relation.body);
}

std::optional<Program> lower_metrics(const sema::Model& model,
                                     std::span<const sema::Metric> metrics,
                                     const std::vector<Body>& bodies, const sema::Frame& frame,
                                     Diagnostics& diagnostics) {
  Lowering lowering(model, bodies, frame, diagnostics);
  for (const sema::Metric& metric : metrics) {
    if (!lowering.metric(metric)) return std::nullopt;
  }
  return lowering.finish();
}

std::optional<Program> lower_relation(const sema::Model& model, const sema::Predicate& relation,
                                      std::span<const std::uint16_t> of,
                                      const std::vector<std::uint16_t>& alike,
                                      const std::vector<Body>& bodies, const sema::Frame& frame,
                                      Diagnostics& diagnostics) {
  Lowering lowering(model, bodies, frame, diagnostics);
  if (!lowering.relation(relation, of, alike)) return std::nullopt;
  return lowering.finish();
}

std::optional<Program> lower_put(const sema::Model& model, const PutBody& put, const Span& span,
                                 const std::vector<Body>& bodies, const sema::Frame& frame,
                                 Diagnostics& diagnostics) {
  Lowering lowering(model, bodies, frame, diagnostics);
  if (!lowering.put(put, span)) return std::nullopt;
  return lowering.finish();
}

std::optional<Program> lower_claim(const sema::Model& model, std::span<const ClaimedBody> claimed,
                                   const std::vector<Body>& bodies, const sema::Frame& frame,
                                   Diagnostics& diagnostics) {
  Lowering lowering(model, bodies, frame, diagnostics);
  for (const ClaimedBody& body : claimed) {
    if (!lowering.claimed(body)) return std::nullopt;
  }
  return lowering.finish();
}

}  // namespace probe::lower
