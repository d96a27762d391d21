// Derivations: a task for each of what is bound.
#include "compiler/syntax/parser_impl.h"

namespace probe::syntax {

DeclNode Parser::derive_decl() {
  advance();
  DeriveDecl out;
  out.name = template_text();
  expect_word("for");
  out.binders = comma_list([this] { return binder(); });
  if (accept_word("where")) out.where = cond();
  out.body = task_body();
  return out;
}

std::optional<BinderDeclared::Of> Parser::declared_pool() {
  if (at_word("lights")) return BinderDeclared::Of::kLights;
  if (at_word("cameras")) return BinderDeclared::Of::kCameras;
  if (at_word("scenes")) return BinderDeclared::Of::kScenes;
  if (at_word("robots")) return BinderDeclared::Of::kRobots;
  if (at_word("fixtures")) return BinderDeclared::Of::kFixtures;
  return std::nullopt;
}

// A comma goes on with numbers where a number stands behind it, else with binders.
BinderNumbers Parser::binder_numbers() {
  BinderNumbers out;
  out.values.push_back(quantity());
  if (accept(TokenKind::kDotDot)) {
    out.last = quantity();
    return out;
  }
  while (at(TokenKind::kComma) &&
         (kind_ahead(1) == TokenKind::kNumber || kind_ahead(1) == TokenKind::kMinus)) {
    advance();
    out.values.push_back(quantity());
  }
  return out;
}

Binder Parser::binder() {
  Binder out;
  const std::uint32_t begin = mark();
  out.name = name();
  expect_word("in");
  const bool clear = at_word("clear") && text_ahead(1) == "phrases" && text_ahead(3) == "of";
  if (clear ||
      (at_word("phrases") && kind_ahead(1) == TokenKind::kIdent && text_ahead(2) == "of")) {
    advance();
    if (clear) expect_word("phrases");
    BinderPhrases phrases;
    phrases.clear = clear;
    phrases.axis = name();
    expect_word("of");
    phrases.role = name();
    out.over = phrases;
  } else if (at_word("templates") && text_ahead(1) == "of") {
    advance();
    expect_word("of");
    out.over = BinderTemplates{name()};
  } else if (kind() == TokenKind::kIdent && text_ahead(1) == "of" && !at_word("variants")) {
    BinderDistractors others;
    others.role = name();
    expect_word("of");
    others.task = name();
    out.over = others;
  } else if (at(TokenKind::kNumber) || at(TokenKind::kMinus)) {
    out.over = binder_numbers();
  } else if (const auto declared = declared_pool();
             declared && kind_ahead(1) == TokenKind::kLeftParen) {
    advance();
    expect(TokenKind::kLeftParen);
    out.over = BinderDeclared{*declared, names()};
    expect(TokenKind::kRightParen);
  } else if ((at_word("objects") || at_word("parts")) && kind_ahead(1) == TokenKind::kLeftParen) {
    advance();
    expect(TokenKind::kLeftParen);
    out.over = BinderObjects{comma_list([this] { return thing(); })};
    expect(TokenKind::kRightParen);
  } else if (at(TokenKind::kLeftParen) && kind_ahead(1) == TokenKind::kIdent &&
             kind_ahead(2) == TokenKind::kComma) {
    fail(Code::P0101, here(),
         "a list of names has a word before it that says of what: `lights (..)`, `cameras`, `scenes`, "
         "`robots`, `fixtures`, `objects` or `parts`; tasks stand in braces");
  } else if ((declared_pool() || at_word("objects") || at_word("parts")) &&
             kind_ahead(1) == TokenKind::kIdent && text_ahead(1) != "where") {
    // No set: two names behind one another are none.
    advance();
    expect(TokenKind::kLeftParen);
  } else {
    out.over = BinderTasks{task_set_without_where()};
  }
  out.span = since(begin);
  return out;
}

}  // namespace probe::syntax
