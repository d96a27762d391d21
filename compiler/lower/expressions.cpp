// Values of expressions: inner ones first, so that the code reads like the text.
#include <cmath>
#include <numbers>
#include <utility>

#include "compiler/lower/lowering.h"
#include "runtime/base/trig.h"

namespace probe::lower {

Value Lowering::fail(const Span& span, std::string message) {
  if (ok_) diagnostics_.report(Code::P0601, span, std::move(message));
  ok_ = false;
  return Value::of_truth(false);
}

Value Lowering::eval(ExprRef ref) {
  // A program that is too long or wrong is not used: stop unrolling it.
  if (!ok_ || builder_.is_full()) return Value::of_truth(false);
  const ExprNode& node = model_.exprs.nodes[ref];
  if (++visited_ > kMostVisited)
    return fail(node.span, "the predicates of this task call one another too often to unroll");
  if (!joins_travels(node)) return value_of(node);
  // Of a parameter it is known only here whether a part slides or turns.
  const unsigned before = std::exchange(motions_, 0U);
  const Value value = value_of(node);
  const unsigned met = motions_;
  motions_ = before | (is_travel(node) ? met : 0U);
  if (met == (kSlidesMet | kTurnsMet))
    return fail(node.span, "a length and an angle: one of these parts slides, another turns");
  return value;
}

bool Lowering::joins_travels(const ExprNode& node) const {
  const bool multiplies = node.op == ExprOp::kMultiply || node.op == ExprOp::kDivide;
  if (node.args.size() < 2 || node.op == ExprOp::kCall || multiplies) return false;
  return std::ranges::all_of(node.args,
                             [&](ExprRef arg) { return is_travel(model_.exprs.nodes[arg]); });
}

Value Lowering::value_of(const ExprNode& node) {
  switch (node.op) {
    case ExprOp::kPoison:
      return fail(node.span, "this has no value");
    case ExprOp::kConstant:
      return constant(node);
    case ExprOp::kRole:
      return in_role(node);
    case ExprOp::kObject:
      return only(node, [&](const Body& b) {
        return b.kind == plan::BodyKind::kObject && b.index == node.a;
      });
    case ExprOp::kFixture:
      return only(node, [](const Body& b) { return b.kind == plan::BodyKind::kFixture; });
    case ExprOp::kSurface:
      return surface();
    case ExprOp::kPart:
      return part(node);
    case ExprOp::kJoint:
      return joint(node, node.a, node.b);
    case ExprOp::kRegion:
      return region(node);
    case ExprOp::kRegionOf:
      return region_of(node);
    case ExprOp::kStanding:
      return standing(node);
    case ExprOp::kVariable:
      return variables_[node.a];
    case ExprOp::kVector:
      return vector(node);
    case ExprOp::kMeasure:
      return measure(node);
    case ExprOp::kCall:
      return call(node);
    case ExprOp::kAdd:
    case ExprOp::kSubtract:
    case ExprOp::kMultiply:
    case ExprOp::kDivide:
      return arithmetic(node);
    case ExprOp::kNegate:
      return negate(node);
    case ExprOp::kLess:
      return compare(node, false);
    case ExprOp::kLessEqual:
      return compare(node, true);
    case ExprOp::kEqual: {
      const Value a = eval(node.args[0]);
      const Value b = eval(node.args[1]);
      builder_.at(node.span);
      return builder_.logical_and(builder_.less(a, b, true), builder_.less(b, a, true));
    }
    case ExprOp::kAnd:
    case ExprOp::kOr:
      return chain(node);
    case ExprOp::kNot: {
      const Value operand = eval(node.args[0]);
      builder_.at(node.span);
      return builder_.logical_not(operand);
    }
    case ExprOp::kOnce:
      return monitor(node, Op::kONCE);
    case ExprOp::kAlways:
      return monitor(node, Op::kALWAYS);
    case ExprOp::kHold:
      return monitor(node, Op::kHOLD);
    case ExprOp::kAny:
    case ExprOp::kAll:
    case ExprOp::kNo:
      return quantified(node);
  }
  return Value::of_truth(false);
}

Value Lowering::constant(const ExprNode& node) {
  const sema::Quantity& quantity = model_.exprs.quantities[node.a];
  Value value = Value::of_number(quantity.si());
  if (quantity.dimension == sema::dim::kAngle) value.angle = quantity;
  return value;
}

Value Lowering::vector(const ExprNode& node) {
  double parts[3] = {};
  for (std::size_t i = 0; i < 3; ++i) {
    const Value part = eval(node.args[i]);
    if (part.kind != Value::kNumber)
      return fail(model_.exprs.nodes[node.args[i]].span,
                  "the numbers of a vector are constants, this is measured");
    parts[i] = part.number;
  }
  builder_.at(node.span);
  return Value::of_register(builder_.vector(parts[0], parts[1], parts[2]));
}

Value Lowering::call(const ExprNode& node) {
  const sema::Predicate& predicate = model_.predicates[node.predicate];
  std::vector<Value> inner(predicate.variables);
  for (std::size_t i = 0; i < node.args.size(); ++i) {
    inner[i] = eval(node.args[i]);
    const sema::Type& wanted = predicate.parameters[i].type;
    const char kind = wanted.kind == sema::TypeKind::kRegion ? 'G'
                      : wanted.kind != sema::TypeKind::kBody ? ' '
                      : wanted.is_object                     ? 'O'
                      : wanted.is_part                       ? 'A'
                                                             : 'B';
    // What a parameter stands for was looked at where it was given.
    if (ok_ && model_.exprs.nodes[node.args[i]].type.is_open)
      fits(model_.exprs.nodes[node.args[i]].span, inner[i], kind,
           "`" + predicate.parameters[i].name + "` of `" + predicate.name + "`");
  }
  if (!ok_) return Value::of_truth(false);
  std::swap(inner, variables_);
  const Value value = eval(predicate.body);
  std::swap(inner, variables_);
  return value;
}

Value Lowering::monitor(const ExprNode& node, Op op) {
  const Value operand = eval(node.args[0]);
  builder_.at(node.span);
  return builder_.monitor(op, operand,
                          op == Op::kHOLD ? static_cast<std::uint16_t>(node.a) : std::uint16_t{0});
}

Value Lowering::join(const std::vector<Value>& values, bool all, const Span& span) {
  builder_.at(span);
  Value result = Value::of_truth(all);
  for (const Value& value : values) {
    result = all ? builder_.logical_and(result, value) : builder_.logical_or(result, value);
  }
  return result;
}

Value Lowering::chain(const ExprNode& node) {
  std::vector<Value> values;
  for (const ExprRef arg : node.args) values.push_back(eval(arg));
  return join(values, node.op == ExprOp::kAnd, node.span);
}

Value Lowering::quantified(const ExprNode& node) {
  std::vector<Value> values;
  const Bodies all = members(node.set);
  if (all.empty()) empty_.insert(model_.exprs.sets[node.set].span);
  for (const std::uint16_t body : all) {
    variables_[node.a] = Value::of_body(body);
    values.push_back(eval(node.args[0]));
  }
  const Value result = join(values, node.op == ExprOp::kAll, node.span);
  return node.op == ExprOp::kNo ? builder_.logical_not(result) : result;
}

Value Lowering::arithmetic(const ExprNode& node) {
  const Value a = eval(node.args[0]);
  const Value b = eval(node.args[1]);
  builder_.at(node.span);
  if (node.type.kind == sema::TypeKind::kVector) {
    const Op op = node.op == ExprOp::kAdd        ? Op::kVADD
                  : node.op == ExprOp::kSubtract ? Op::kVSUB
                                                 : Op::kVSCALE;
    const std::uint16_t right = builder_.in_register(b);
    return Value::of_register(builder_.emit(op, a.index, right));
  }
  if (node.op != ExprOp::kDivide) {
    const Op op = node.op == ExprOp::kAdd        ? Op::kADD
                  : node.op == ExprOp::kSubtract ? Op::kSUB
                                                 : Op::kMUL;
    return finite(builder_.arithmetic(op, a, b), node.span);
  }
  if (a.kind == Value::kNumber && b.kind == Value::kNumber && b.number != 0)
    return finite(Value::of_number(a.number / b.number), node.span);
  return fail(node.span, "the judge has no division: write `a < k * b` for `a / b < k`");
}

Value Lowering::finite(const Value& value, const Span& span) {
  if (value.kind != Value::kNumber || std::isfinite(value.number)) return value;
  return fail(span, "this is larger than any number that is kept");
}

Value Lowering::negate(const ExprNode& node) {
  const Value operand = eval(node.args[0]);
  builder_.at(node.span);
  if (node.type.kind != sema::TypeKind::kVector) return builder_.negate(operand);
  return Value::of_register(builder_.emit(Op::kVSCALE, operand.index, builder_.constant(-1)));
}

Value Lowering::compare(const ExprNode& node, bool or_equal) {
  const bool left_angle = model_.exprs.nodes[node.args[0]].type.is_angle_between;
  const bool right_angle = model_.exprs.nodes[node.args[1]].type.is_angle_between;
  if (left_angle || right_angle) return compare_angle(node, left_angle, or_equal);
  // `a > b` is stored as `b < a`; evaluation follows the text, so that the code reads like it.
  const bool swapped =
      model_.exprs.nodes[node.args[1]].span.begin < model_.exprs.nodes[node.args[0]].span.begin;
  const Value first = eval(node.args[swapped ? 1 : 0]);
  const Value second = eval(node.args[swapped ? 0 : 1]);
  builder_.at(node.span);
  return swapped ? builder_.less(second, first, or_equal) : builder_.less(first, second, or_equal);
}

Value Lowering::compare_angle(const ExprNode& node, bool angle_on_left, bool or_equal) {
  const ExprNode& between = model_.exprs.nodes[node.args[angle_on_left ? 0 : 1]];
  const Value limit = eval(node.args[angle_on_left ? 1 : 0]);
  if (limit.kind != Value::kNumber) return fail(node.span, "`angle` is compared with a constant");
  constexpr double kHalfTurn = std::numbers::pi;
  if (!(limit.number >= 0 && limit.number <= kHalfTurn)) {
    if (ok_)
      diagnostics_
          .report(Situation::kAngleRange, model_.exprs.nodes[node.args[angle_on_left ? 1 : 0]].span,
                  "the angle between two vectors is 0deg to 180deg")
          .label(between.span, "compared with this");
    ok_ = false;
    return Value::of_truth(false);
  }
  // At the ends the comparison says nothing, or nothing can pass it.
  if (angle_on_left && limit.number == (or_equal ? kHalfTurn : 0)) return Value::of_truth(or_equal);
  if (!angle_on_left && limit.number == (or_equal ? 0 : kHalfTurn))
    return Value::of_truth(or_equal);
  const std::uint16_t u = eval(between.args[0]).index;
  const std::uint16_t v = eval(between.args[1]).index;
  builder_.at(node.span);
  const double cosine = limit.angle ? limit.angle->cosine() : portable_cos(limit.number);
  const std::uint16_t u_length = builder_.emit(Op::kVLEN, u);
  const std::uint16_t v_length = builder_.emit(Op::kVLEN, v);
  const std::uint16_t scaled = builder_.emit(Op::kMUL, builder_.constant(cosine), u_length);
  const Value edge = Value::of_register(builder_.emit(Op::kMUL, scaled, v_length));
  const Value dot = Value::of_register(builder_.emit(Op::kVDOT, u, v));
  return angle_on_left ? builder_.less(edge, dot, or_equal) : builder_.less(dot, edge, or_equal);
}

}  // namespace probe::lower
