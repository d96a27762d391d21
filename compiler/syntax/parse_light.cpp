// Lights.
#include "compiler/syntax/parser_impl.h"

namespace probe::syntax {

DeclNode Parser::light_decl() {
  static constexpr Rule<LightStmt> kRules[] = {
#define PROBE_IN_LIGHT(word, parse, repeat) {#word, &Parser::parse},
#include "compiler/syntax/keywords.def"
  };
  advance();
  LightDecl out;
  out.name = name();
  out.body = body<LightStmt>(kRules, "a statement of `light`");
  return out;
}

LightStmt Parser::light_ambient() {
  AmbientStmt out;
  out.value = quantity();
  if (accept_word("occlusion")) out.occlusion = integer();
  return out;
}

LightStmt Parser::light_sun() {
  SunStmt out;
  out.direction = point();
  expect_word("power");
  out.power = quantity();
  out.shadow = accept_word("shadow");
  return out;
}

LightStmt Parser::light_color() { return LightColorStmt{{}, point()}; }

}  // namespace probe::syntax
