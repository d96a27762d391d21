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
  if (accept_word("specular")) out.specular = quantity();
  out.shadow = accept_word("shadow");
  return out;
}

LightStmt Parser::light_spot() {
  LampStmt out;
  expect_word("at");
  out.place = point();
  expect_word("along");
  out.direction = point();
  lamp_strength(out);
  if (accept_word("cutoff")) out.cutoff = quantity();
  if (accept_word("exponent")) out.exponent = quantity();
  if (accept_word("fade")) out.fade = point();
  return out;
}

LightStmt Parser::light_headlight() {
  LampStmt out;
  lamp_strength(out);
  return out;
}

void Parser::lamp_strength(LampStmt& lamp) {
  expect_word("power");
  lamp.power = quantity();
  if (accept_word("specular")) lamp.specular = quantity();
  if (accept_word("ambient")) lamp.ambient = quantity();
}

LightStmt Parser::light_shading() {
  expect_word("vertex");
  return ShadingStmt{};
}

LightStmt Parser::light_color() { return LightColorStmt{{}, point()}; }

}  // namespace probe::syntax
