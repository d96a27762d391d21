// Attributes and facts of objects, and queries over them.
#include "compiler/syntax/parser_impl.h"

namespace probe::syntax {

DeclNode Parser::attribute_decl() {
  advance();
  AttributeDecl out;
  out.name = name();
  out.values = braced_names();
  return out;
}

DeclNode Parser::facts_decl() {
  advance();
  return FactsDecl{braced_names()};
}

QueryId Parser::add(Query node, std::initializer_list<QueryId> children) {
  return add_node(file_.queries, query_heights_, std::move(node), children);
}

QueryId Parser::query() {
  const std::uint32_t begin = mark();
  QueryId left = query_and();
  while (accept_word("or")) {
    const QueryId right = query_and();
    left = add(Query{since(begin), QueryOr{left, right}}, {left, right});
  }
  return left;
}

QueryId Parser::query_and() {
  const std::uint32_t begin = mark();
  QueryId left = query_not();
  while (accept_word("and")) {
    const QueryId right = query_not();
    left = add(Query{since(begin), QueryAnd{left, right}}, {left, right});
  }
  return left;
}

QueryId Parser::query_not() {
  const NestingGuard guard(*this);
  if (!guard.ok) return {};
  const std::uint32_t begin = mark();
  if (accept_word("not")) {
    const QueryId operand = query_not();
    return add(Query{since(begin), QueryNot{operand}}, {operand});
  }
  if (accept(TokenKind::kLeftParen)) {
    const QueryId inner = query();
    expect(TokenKind::kRightParen);
    return inner;
  }
  const Name first = name();
  if (at(TokenKind::kLeftParen)) {
    set_role(TokenRole::kTightParen);
    accept(TokenKind::kLeftParen);
    QueryRelation out{first, names()};
    if (!failed_ && at(TokenKind::kDot)) {
      fail(Code::P0101, here(),
           "found `.`, expected `)`: a relation in a phrase takes objects, not parts or regions of "
           "fixtures");
    }
    expect(TokenKind::kRightParen);
    if (failed_) return {};
    return add(Query{since(begin), std::move(out)}, {});
  }
  const std::string_view next = kind() == TokenKind::kIdent ? text_at(pos_) : std::string_view();
  if (next.empty() || next == "and" || next == "or" || next == "not") {
    return add(Query{since(begin), QueryFact{first}}, {});
  }
  const Name value = name();
  return add(Query{since(begin), QueryValue{first, value}}, {});
}

}  // namespace probe::syntax
