// Predicates and their parameters.
#include "compiler/syntax/parser_impl.h"

namespace probe::syntax {
namespace {

struct TypeWord {
  std::string_view word;
  ParamType type;
};
constexpr TypeWord kTypes[] = {{"object", ParamType::kObject}, {"body", ParamType::kBody},
                               {"part", ParamType::kPart},     {"region", ParamType::kRegion},
                               {"length", ParamType::kLength}, {"angle", ParamType::kAngle},
                               {"time", ParamType::kTime},     {"impulse", ParamType::kImpulse},
                               {"number", ParamType::kNumber}};

}  // namespace

DeclNode Parser::predicate_decl() { return predicate_or_relation(false); }

DeclNode Parser::relation_decl() { return predicate_or_relation(true); }

PredicateDecl Parser::predicate_or_relation(bool is_relation) {
  advance();
  PredicateDecl out;
  out.is_relation = is_relation;
  out.name = name();
  set_role(TokenRole::kTightParen);
  expect(TokenKind::kLeftParen);
  if (!at(TokenKind::kRightParen)) out.params = comma_list([this] { return param(); });
  expect(TokenKind::kRightParen);
  if (is_relation) out.words = comma_list([this] { return string(); });
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

}  // namespace probe::syntax
