// Sets of bodies in quantifiers: `bodies - {a, b}`.
#include "compiler/syntax/parser_impl.h"

namespace probe::syntax {

namespace {

bool is_name(std::string_view text) {
  return !text.empty() &&
         ((text[0] >= 'a' && text[0] <= 'z') || (text[0] >= 'A' && text[0] <= 'Z'));
}

}  // namespace

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
    SetNames out{braced_things()};
    return add(SetExpr{since(begin), std::move(out)}, {});
  }
  // A role may be called so; then no name follows.
  if (at_word("whole") && is_name(text_ahead(1))) {
    advance();
    return add(SetExpr{since(begin), SetWhole{thing()}}, {});
  }
  const Name only = name();
  return add(SetExpr{since(begin), SetName{only}}, {});
}

}  // namespace probe::syntax
