// Rules of language and judgement: templates, predicates, metrics, expressions over bodies.
#include <algorithm>
#include <array>

#include "compiler/syntax/parser_impl.h"

namespace probe::syntax {
namespace {

struct TypeWord {
  std::string_view word;
  ParamType type;
};
constexpr TypeWord kTypes[] = {{"object", ParamType::kObject}, {"body", ParamType::kBody},
                               {"length", ParamType::kLength}, {"angle", ParamType::kAngle},
                               {"time", ParamType::kTime},     {"impulse", ParamType::kImpulse},
                               {"number", ParamType::kNumber}};

struct Comparison {
  TokenKind token;
  BinaryOp op;
};
constexpr Comparison kComparisons[] = {
    {TokenKind::kLess, BinaryOp::kLess},       {TokenKind::kLessEqual, BinaryOp::kLessEqual},
    {TokenKind::kGreater, BinaryOp::kGreater}, {TokenKind::kGreaterEqual, BinaryOp::kGreaterEqual},
    {TokenKind::kEqual, BinaryOp::kEqual},     {TokenKind::kNotEqual, BinaryOp::kNotEqual}};

}  // namespace

DeclNode Parser::template_decl() {
  advance();
  TemplateDecl out;
  out.name = name();
  out.frame = optional_name_after("frame");
  out.text = template_text();
  return out;
}

DeclNode Parser::predicate_decl() {
  advance();
  PredicateDecl out;
  out.name = name();
  set_role(TokenRole::kTightParen);
  expect(TokenKind::kLeftParen);
  if (!at(TokenKind::kRightParen)) out.params = comma_list([this] { return param(); });
  expect(TokenKind::kRightParen);
  expect(TokenKind::kAssign);
  skip_newlines();
  out.body = expr();
  return out;
}

Param Parser::param() {
  Param out;
  const std::uint32_t begin = mark();
  out.name = name();
  expect(TokenKind::kColon);
  out.type_span = here();
  bool known = false;
  for (const TypeWord& type : kTypes) {
    if (!known && accept_word(type.word)) {
      out.type = type.type;
      known = true;
    }
  }
  if (!known) {
    expected_count_ = 0;
    for (const TypeWord& type : kTypes) at_word(type.word);
    fail_expected("a type");
  }
  if (accept(TokenKind::kAssign)) out.default_value = expr();
  out.span = since(begin);
  return out;
}

DeclNode Parser::metrics_decl() {
  advance();
  MetricsDecl out;
  out.name = name();
  out.like = optional_name_after("like");
  block({}, [&] {
    MetricStmt stmt = metric();
    if (!failed_) out.body.push_back(std::move(stmt));
  });
  return out;
}

MetricStmt Parser::metric() {
  MetricStmt out;
  const std::uint32_t begin = mark();
  out.name = name();
  expect(TokenKind::kAssign);
  out.readout = readout();
  out.span = since(begin);
  return out;
}

Readout Parser::readout() {
  Readout out;
  const std::uint32_t begin = mark();
  const auto found = std::ranges::find_if(
      plan::kReadoutTable, [this](const plan::ReadoutInfo& info) { return accept_words(info.words); });
  if (found == plan::kReadoutTable.end()) {
    fail_expected("a read-out");
  } else {
    out.kind = found->readout;
  }
  out.kind_span = since(begin);
  out.expr = expr();
  out.span = since(begin);
  return out;
}

// ---- expressions
// ----------------------------------------------------------------------------------------------------

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
    block({}, [&] {
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

ExprId Parser::call_or_name() {
  const std::uint32_t begin = mark();
  const Name first = name();
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

// ---- sets of bodies
// -------------------------------------------------------------------------------------------------

SetExprId Parser::add(SetExpr node, std::initializer_list<SetExprId> children) {
  return add_node(file_.set_exprs, set_expr_heights_, std::move(node), children);
}

std::optional<SetOp> Parser::set_operator() {
  if (accept(TokenKind::kPipe)) return SetOp::kUnion;
  if (accept(TokenKind::kAmpersand)) return SetOp::kIntersection;
  if (accept(TokenKind::kMinus)) return SetOp::kDifference;
  return std::nullopt;
}

SetExprId Parser::set_expr() {
  const std::uint32_t begin = mark();
  SetExprId left = set_operand();
  while (const std::optional<SetOp> op = set_operator()) {
    const SetExprId right = set_operand();
    if (failed_) return {};
    left = add(SetExpr{since(begin), SetBinary{*op, left, right}}, {left, right});
  }
  return left;
}

SetExprId Parser::set_operand() {
  const NestingGuard guard(*this);
  if (!guard.ok) return {};
  const std::uint32_t begin = mark();
  if (accept(TokenKind::kLeftParen)) {
    const SetExprId inner = set_expr();
    expect(TokenKind::kRightParen);
    return inner;
  }
  if (at(TokenKind::kLeftBrace)) {
    set_role(TokenRole::kTightBrace);
    SetNames out{braced_names()};
    return add(SetExpr{since(begin), std::move(out)}, {});
  }
  const Name only = name();
  return add(SetExpr{since(begin), SetName{only}}, {});
}

}  // namespace probe::syntax
