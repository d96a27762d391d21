// Operators, memories and quantifiers of expressions.
#include <algorithm>

#include "compiler/define/expr.h"

namespace probe::sema {

ExprRef ExprReader::read_node(const Span& span, const syntax::ExprUnary& unary) {
  const ExprRef operand = plain(read(unary.operand));
  if (unary.op == syntax::UnaryOp::kNegate) {
    const Type type = node(operand).type;
    if (type.kind == TypeKind::kVector || is_poison(operand))
      return is_poison(operand) ? operand : negate_vector(span, operand);
    const ExprRef number = expect(operand, TypeKind::kReal, "a number");
    if (is_poison(number)) return number;
    return add(ExprOp::kNegate, real_type(type.dimension), span, {number});
  }
  const ExprRef condition = expect(operand, TypeKind::kBool, "a condition");
  if (is_poison(condition)) return condition;
  const ExprOp op = unary.op == syntax::UnaryOp::kNot    ? ExprOp::kNot
                    : unary.op == syntax::UnaryOp::kOnce ? ExprOp::kOnce
                                                         : ExprOp::kAlways;
  return add(op, bool_type(), span, {condition});
}

ExprRef ExprReader::read_node(const Span& span, const syntax::ExprVector& vector) {
  std::vector<ExprRef> parts;
  for (const syntax::ExprId id : vector.parts) {
    const ExprRef part = expect(plain(read(id)), TypeKind::kReal, "a number");
    if (is_poison(part)) return part;
    if (!parts.empty() && !same_dimension(part, parts.front())) return poison(span);
    parts.push_back(part);
  }
  return add(ExprOp::kVector, {TypeKind::kVector, node(parts.front()).type.dimension}, span, parts);
}

ExprRef ExprReader::negate_vector(const Span& span, ExprRef operand) {
  return add(ExprOp::kNegate, node(operand).type, span, {operand});
}

ExprRef ExprReader::read_node(const Span& span, const syntax::ExprBinary& binary) {
  using syntax::BinaryOp;
  if (binary.op == BinaryOp::kAnd || binary.op == BinaryOp::kOr) return logical(span, binary);
  const ExprRef left = read(binary.left);
  const ExprRef right = read(binary.right);
  if (is_poison(left) || is_poison(right)) return poison(span);
  if (binary.op >= BinaryOp::kLess && binary.op <= BinaryOp::kNotEqual)
    return comparison(span, binary.op, left, right);
  return arithmetic(span, binary, plain(left), plain(right));
}

ExprRef ExprReader::logical(const Span& span, const syntax::ExprBinary& binary) {
  const ExprRef left = condition(binary.left);
  const ExprRef right = condition(binary.right);
  if (is_poison(left) || is_poison(right)) return poison(span);
  return add(binary.op == syntax::BinaryOp::kAnd ? ExprOp::kAnd : ExprOp::kOr, bool_type(), span,
             {left, right});
}

ExprRef ExprReader::comparison(const Span& span, syntax::BinaryOp op, ExprRef left, ExprRef right) {
  using syntax::BinaryOp;
  left = expect(left, TypeKind::kReal, "a number");
  right = expect(right, TypeKind::kReal, "a number");
  if (is_poison(left) || is_poison(right)) return poison(span);
  if (node(left).type.is_angle_between && node(right).type.is_angle_between) {
    context_.report(Code::P0601, span, "`angle` is compared with a constant");
    return poison(span);
  }
  if (!same_dimension(left, right)) return poison(span);
  switch (op) {
    case BinaryOp::kLess:
      return add(ExprOp::kLess, bool_type(), span, {left, right});
    case BinaryOp::kLessEqual:
      return add(ExprOp::kLessEqual, bool_type(), span, {left, right});
    case BinaryOp::kGreater:
      return add(ExprOp::kLess, bool_type(), span, {right, left});
    case BinaryOp::kGreaterEqual:
      return add(ExprOp::kLessEqual, bool_type(), span, {right, left});
    default:
      break;
  }
  // Counts are whole numbers; anything measured in units is never equal twice.
  if (!(node(left).type.dimension == dim::kNumber)) {
    context_.report(Code::P0606, span, "measured values are compared for equality")
        .help("give a tolerance: `abs(a - b) <= 1mm`");
  }
  plain(left), plain(right);
  const ExprRef equal = add(ExprOp::kEqual, bool_type(), span, {left, right});
  return op == BinaryOp::kEqual ? equal : add(ExprOp::kNot, bool_type(), span, {equal});
}

ExprRef ExprReader::arithmetic(const Span& span, const syntax::ExprBinary& binary, ExprRef left,
                               ExprRef right) {
  using syntax::BinaryOp;
  const Type a = node(left).type;
  const Type b = node(right).type;
  if (is_poison(left) || is_poison(right)) return poison(span);
  const bool is_sum = binary.op == BinaryOp::kAdd || binary.op == BinaryOp::kSubtract;
  const ExprOp op = binary.op == BinaryOp::kAdd        ? ExprOp::kAdd
                    : binary.op == BinaryOp::kSubtract ? ExprOp::kSubtract
                    : binary.op == BinaryOp::kMultiply ? ExprOp::kMultiply
                                                       : ExprOp::kDivide;
  const bool numbers = a.kind == TypeKind::kReal && b.kind == TypeKind::kReal;
  const bool vectors = a.kind == TypeKind::kVector && b.kind == TypeKind::kVector;
  if (is_sum && (numbers || vectors)) {
    if (!same_dimension(left, right)) return poison(span);
    return add(op, a, span, {left, right});
  }
  if (op == ExprOp::kMultiply && numbers)
    return add(op, real_type(a.dimension * b.dimension), span, {left, right});
  if (op == ExprOp::kMultiply && a.kind == TypeKind::kVector && b.kind == TypeKind::kReal) {
    return add(op, {TypeKind::kVector, a.dimension * b.dimension}, span, {left, right});
  }
  if (op == ExprOp::kMultiply && a.kind == TypeKind::kReal && b.kind == TypeKind::kVector) {
    return add(op, {TypeKind::kVector, a.dimension * b.dimension}, span, {right, left});
  }
  if (op == ExprOp::kDivide && numbers)
    return add(op, real_type(a.dimension / b.dimension), span, {left, right});
  context_.report(Code::P0601, span,
                  "found " + type_name(a) + " and " + type_name(b) + " where numbers are combined");
  return poison(span);
}

ExprRef ExprReader::read_node(const Span& span, const syntax::ExprHold& hold) {
  const ExprRef operand = condition(hold.operand);
  if (is_poison(operand)) return operand;
  if (hold.steps.value < 1 || hold.steps.value > 65535) {
    context_.report(Situation::kHoldLength, hold.steps.span, "expected 1 to 65535 steps");
    return poison(span);
  }
  return add(ExprOp::kHold, bool_type(), hold.for_span, {operand},
             static_cast<std::uint32_t>(hold.steps.value));
}

ExprRef ExprReader::read_node(const Span& span, const syntax::ExprBlock& block) {
  std::vector<ExprRef> conditions;
  bool fits = true;
  for (const syntax::ExprId id : block.conditions) {
    conditions.push_back(condition(id));
    fits = fits && !is_poison(conditions.back());
  }
  if (!fits || conditions.empty()) return poison(span);
  const bool all = block.quantifier == syntax::Quantifier::kAll;
  const ExprRef whole =
      add(all ? ExprOp::kAnd : ExprOp::kOr, bool_type(), span, std::move(conditions));
  return block.quantifier == syntax::Quantifier::kNo ? add(ExprOp::kNot, bool_type(), span, {whole})
                                                     : whole;
}

ExprRef ExprReader::read_node(const Span& span, const syntax::ExprQuantified& quantified) {
  const auto set = read_set(quantified.set);
  if (!set) return poison(span);
  const std::uint32_t index = variables_;
  Type member{TypeKind::kBody, dim::kNumber, only_objects(*set)};
  member.is_part = only_parts(*set);
  member.is_open = !member.is_part && may_have_parts(*set);
  add_variable(quantified.variable.text, member);
  const ExprRef body = condition(quantified.body);
  scope_.pop_back();
  if (is_poison(body)) return body;
  const ExprOp op = quantified.quantifier == syntax::Quantifier::kAny   ? ExprOp::kAny
                    : quantified.quantifier == syntax::Quantifier::kAll ? ExprOp::kAll
                                                                        : ExprOp::kNo;
  const ExprRef ref = add(op, bool_type(), span, {body}, index);
  arena().nodes[ref].set = *set;
  return ref;
}

}  // namespace probe::sema
