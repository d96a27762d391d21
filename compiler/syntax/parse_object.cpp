// Objects of the catalogue.
#include "compiler/syntax/parser_impl.h"

namespace probe::syntax {

DeclNode Parser::object_decl() {
  advance();
  ObjectDecl out;
  out.name = name();
  out.like = optional_name_after("like");
  out.body = object_body();
  return out;
}

DeclNode Parser::extend_decl() {
  advance();
  expect_word("object");
  ExtendDecl out;
  out.object = name();
  out.body = object_body();
  return out;
}

std::vector<ObjectStmt> Parser::object_body() {
  static constexpr Rule<ObjectStmt> kRules[] = {
#define PROBE_IN_OBJECT(word, parse, repeat) {#word, &Parser::parse},
#include "compiler/syntax/keywords.def"
  };
  return body<ObjectStmt>(kRules, "a statement of `object`", &Parser::object_attribute);
}

ObjectStmt Parser::object_mesh() { return MeshStmt{{}, string()}; }

ObjectStmt Parser::object_box() {
  if (at(TokenKind::kLeftParen)) {
    BoxCornersStmt out;
    out.low = point();
    expect(TokenKind::kDotDot);
    out.high = point();
    return out;
  }
  BoxSizeStmt out;
  out.x = quantity();
  expect_word("x");
  out.y = quantity();
  expect_word("x");
  out.z = quantity();
  return out;
}

ObjectStmt Parser::object_density() { return DensityStmt{{}, quantity()}; }

ObjectStmt Parser::object_mass() {
  MassStmt out;
  out.value = quantity();
  if (!accept_word("com")) return out;
  out.centre = point();
  expect_word("inertia");
  out.inertia = point();
  return out;
}

ObjectStmt Parser::object_damping() {
  ObjectDampingStmt out;
  out.shift = quantity();
  if (at(TokenKind::kNumber) || at(TokenKind::kMinus)) out.turn = quantity();
  return out;
}

ObjectStmt Parser::object_friction() { return FrictionStmt{{}, quantity()}; }

ObjectStmt Parser::object_scale() { return ScaleStmt{{}, quantity()}; }

ObjectStmt Parser::object_paint() {
  PaintStmt out;
  if (at(TokenKind::kLeftParen)) {
    out.color = point();
  } else {
    out.color = name();
  }
  return out;
}

ObjectStmt Parser::object_texture() { return texture(false); }

TextureStmt Parser::texture(bool has_owner) {
  TextureStmt out;
  if (has_owner) out.of = name();
  out.picture = string();
  if (at(TokenKind::kNumber)) out.side = quantity();
  return out;
}

ObjectStmt Parser::object_is() { return IsStmt{{}, names()}; }

ObjectStmt Parser::object_maybe() { return MaybeStmt{{}, names()}; }

ObjectStmt Parser::object_seen() {
  expect_word("in");
  return SeenInStmt{{}, names()};
}

ObjectStmt Parser::object_unseen() { return UnseenStmt{}; }

ObjectStmt Parser::object_rest() { return RestStmt{{}, poses()}; }

ObjectStmt Parser::object_region() { return region(false); }

ObjectStmt Parser::object_name() {
  NameStmt out{{}, string(), false};
  out.bare = accept_word("bare");
  return out;
}

ObjectStmt Parser::object_phrase() {
  PhraseStmt out;
  out.name = name();
  out.axis = name();
  out.text = string();
  out.bare = accept_word("bare");
  expect_word("means");
  out.means = query();
  return out;
}

// Any attribute may stand where no word of the table does: to list the words would mislead.
ObjectStmt Parser::object_attribute() {
  expected_count_ = 0;
  AttributeStmt out;
  out.attribute = name();
  out.values = names();
  return out;
}

}  // namespace probe::syntax
