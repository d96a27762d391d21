// Expressions of predicates and metrics.
#include <algorithm>

#include "compiler/syntax/parser_impl.h"

namespace probe::syntax {
namespace {

struct Comparison {
  TokenKind token;
  BinaryOp op;
};
constexpr Comparison kComparisons[] = {
    {TokenKind::kLess, BinaryOp::kLess},       {TokenKind::kLessEqual, BinaryOp::kLessEqual},
    {TokenKind::kGreater, BinaryOp::kGreater}, {TokenKind::kGreaterEqual, BinaryOp::kGreaterEqual},
    {TokenKind::kEqual, BinaryOp::kEqual},     {TokenKind::kNotEqual, BinaryOp::kNotEqual}};

}  // namespace

ExprId Parser::add(Expr node, std::initializer_list<ExprId> children) {
  return add_node(file_.exprs, expr_heights_, std::move(node), children);
}

ExprId Parser::add_binary(BinaryOp op, const Span& op_span, ExprId left, ExprId right) {
  if (failed_) return {};
  const Span span = join(file_[left].span, file_[right].span);
  return add(Expr{span, ExprBinary{op, op_span, left, right}}, {left, right});
}

ExprId Parser::expr() {
  ExprId left = expr_and();
  while (at_word("or")) {
    const Span op = here();
    advance();
    const ExprId right = expr_and();
    left = add_binary(BinaryOp::kOr, op, left, right);
  }
  return left;
}

ExprId Parser::expr_and() {
  ExprId left = expr_not();
  while (at_word("and")) {
    const Span op = here();
    advance();
    const ExprId right = expr_not();
    left = add_binary(BinaryOp::kAnd, op, left, right);
  }
  return left;
}

ExprId Parser::expr_not() {
  const NestingGuard guard(*this);
  if (!guard.ok) return {};
  const std::uint32_t begin = mark();
  const Span op_span = here();
  const std::string_view word = kind() == TokenKind::kIdent ? text_at(pos_) : std::string_view();
  const auto prefix = [&](UnaryOp op) -> ExprId {
    advance();
    const ExprId operand = expr_not();
    if (failed_) return {};
    return add(Expr{since(begin), ExprUnary{op, op_span, operand}}, {operand});
  };
  if (word == "not") return prefix(UnaryOp::kNot);
  if (word == "once") return prefix(UnaryOp::kOnce);
  if (word == "always") return prefix(UnaryOp::kAlways);
  const bool quantifies = kind_ahead(1) == TokenKind::kIdent && text_ahead(2) == "in";
  const bool opens_block = kind_ahead(1) == TokenKind::kLeftBrace;
  if (word == "any" && (quantifies || opens_block)) return quantified(Quantifier::kAny, begin);
  if (word == "all" && (quantifies || opens_block)) return quantified(Quantifier::kAll, begin);
  if (word == "no" && quantifies) return quantified(Quantifier::kNo, begin);
  return comparison();
}

ExprId Parser::quantified(Quantifier quantifier, std::uint32_t begin) {
  advance();
  if (at(TokenKind::kLeftBrace)) {
    ExprBlock out{quantifier, {}};
    std::uint16_t height = 0;
    block(any_name, [&] {
      const ExprId condition = expr();
      if (failed_) return;
      height = std::max(height, expr_heights_[condition.value]);
      out.conditions.push_back(condition);
    });
    if (failed_) return {};
    if (out.conditions.empty()) {
      fail(Code::P0101, since(begin), "found an empty block, expected one condition a line");
      return {};
    }
    ExprId tallest = out.conditions.front();
    for (const ExprId condition : out.conditions) {
      if (expr_heights_[condition.value] == height) tallest = condition;
    }
    return add(Expr{since(begin), std::move(out)}, {tallest});
  }
  ExprQuantified out;
  out.quantifier = quantifier;
  out.variable = name();
  expect_word("in");
  out.set = set_expr();
  expect(TokenKind::kColon);
  out.body = expr_not();
  if (failed_) return {};
  const ExprId body = out.body;
  return add(Expr{since(begin), std::move(out)}, {body});
}

ExprId Parser::comparison() {
  const std::uint32_t begin = mark();
  ExprId left = sum();
  for (const Comparison& comparison : kComparisons) {
    if (!at(comparison.token)) continue;
    const Span op = here();
    advance();
    const ExprId right = sum();
    left = add_binary(comparison.op, op, left, right);
    break;
  }
  if (!at_word("for")) return left;
  const std::uint32_t for_begin = mark();
  advance();
  ExprHold out;
  out.operand = left;
  out.steps = integer();
  expect_word("steps");
  out.for_span = since(for_begin);
  if (failed_) return {};
  return add(Expr{since(begin), out}, {left});
}

ExprId Parser::sum() {
  ExprId left = product();
  while (at(TokenKind::kPlus) || at(TokenKind::kMinus)) {
    const BinaryOp op = kind() == TokenKind::kPlus ? BinaryOp::kAdd : BinaryOp::kSubtract;
    const Span op_span = here();
    advance();
    const ExprId right = product();
    left = add_binary(op, op_span, left, right);
  }
  return left;
}

ExprId Parser::product() {
  ExprId left = unary();
  while (at(TokenKind::kStar) || at(TokenKind::kSlash)) {
    const BinaryOp op = kind() == TokenKind::kStar ? BinaryOp::kMultiply : BinaryOp::kDivide;
    const Span op_span = here();
    advance();
    const ExprId right = unary();
    left = add_binary(op, op_span, left, right);
  }
  return left;
}

ExprId Parser::unary() {
  const std::uint32_t begin = mark();
  if (at(TokenKind::kMinus)) {
    const NestingGuard guard(*this);
    if (!guard.ok) return {};
    const Span op_span = here();
    set_role(TokenRole::kSign);
    advance();
    const ExprId operand = unary();
    if (failed_) return {};
    return add(Expr{since(begin), ExprUnary{UnaryOp::kNegate, op_span, operand}}, {operand});
  }
  if (accept(TokenKind::kLeftParen)) {
    const ExprId inner = expr();
    if (accept(TokenKind::kComma)) return vector_behind(begin, inner);
    expect(TokenKind::kRightParen);
    return failed_ ? ExprId{} : inner;
  }
  if (at(TokenKind::kNumber)) {
    const Quantity value = quantity();
    return add(Expr{since(begin), ExprNumber{value}}, {});
  }
  if (at(TokenKind::kIdent)) return call_or_name();
  fail_expected();
  return {};
}

// After `(x,`.
ExprId Parser::vector_behind(std::uint32_t begin, ExprId x) {
  ExprVector out{{x, {}, {}}};
  out.parts[1] = expr();
  expect(TokenKind::kComma);
  out.parts[2] = expr();
  expect(TokenKind::kRightParen);
  if (failed_) return {};
  return add(Expr{since(begin), out}, {out.parts[0], out.parts[1], out.parts[2]});
}

ExprId Parser::call_or_name() {
  const std::uint32_t begin = mark();
  const Name first = name();
  if (accept(TokenKind::kDot)) {
    const Name second = name();
    return failed_ ? ExprId{} : add(Expr{since(begin), ExprPath{first, second}}, {});
  }
  if (!at(TokenKind::kLeftParen)) return add(Expr{since(begin), ExprName{first}}, {});
  set_role(TokenRole::kTightParen);
  accept(TokenKind::kLeftParen);
  ExprCall out{first, {}};
  if (!at(TokenKind::kRightParen)) out.arguments = comma_list([this] { return argument(); });
  expect(TokenKind::kRightParen);
  if (failed_) return {};
  ExprId tallest;
  for (const Argument& argument : out.arguments) {
    const bool taller = tallest.value == ExprId::kNone ||
                        expr_heights_[argument.value.value] > expr_heights_[tallest.value];
    if (taller) tallest = argument.value;
  }
  return add(Expr{since(begin), std::move(out)}, {tallest});
}

Argument Parser::argument() {
  Argument out;
  const std::uint32_t begin = mark();
  if (kind() == TokenKind::kIdent && kind_ahead(1) == TokenKind::kColon) {
    out.name = name();
    expect(TokenKind::kColon);
  }
  out.value = expr();
  out.span = since(begin);
  return out;
}

}  // namespace probe::syntax
