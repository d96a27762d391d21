// Fixtures with joints, and regions.
#include "compiler/syntax/parser_impl.h"

namespace probe::syntax {

DeclNode Parser::fixture_decl() {
  static constexpr Rule<FixtureBodyStmt> kRules[] = {
#define PROBE_IN_FIXTURE(word, parse, repeat) {#word, &Parser::parse},
#include "compiler/syntax/keywords.def"
  };
  advance();
  FixtureDecl out;
  out.name = name();
  out.like = optional_name_after("like");
  out.body = body<FixtureBodyStmt>(kRules, "a statement of `fixture`");
  return out;
}

FixtureBodyStmt Parser::fixture_urdf() { return UrdfStmt{{}, string()}; }

FixtureBodyStmt Parser::fixture_at() {
  FixtureAtStmt out;
  out.at = point();
  if (at_any_word({"roll", "pitch", "yaw"})) out.turn = pose();
  return out;
}

FixtureBodyStmt Parser::fixture_friction() { return FrictionStmt{{}, quantity()}; }

FixtureBodyStmt Parser::fixture_joint() {
  FixtureJointStmt out;
  out.joint = name();
  if (accept_word("friction")) out.friction = quantity();
  if (accept_word("damping")) out.damping = quantity();
  if (accept_word("stiffness")) {
    out.stiffness = quantity();
    expect_word("at");
    out.rest = quantity();
  }
  if (accept_word("armature")) out.armature = quantity();
  if (accept_word("start")) out.start = quantity();
  out.stay = accept_word("stay");
  return out;
}

FixtureBodyStmt Parser::fixture_part() {
  PartStmt out;
  out.name = name();
  expect_word("link");
  out.link = name();
  if (accept_word("name")) out.text = string();
  static constexpr Rule<ObjectStmt> kRules[] = {
#define PROBE_IN_PART(word, parse, repeat) {#word, &Parser::parse},
#include "compiler/syntax/keywords.def"
  };
  if (at(TokenKind::kLeftBrace))
    out.body = body<ObjectStmt>(kRules, "a statement of `part`", &Parser::object_attribute);
  return out;
}

FixtureBodyStmt Parser::fixture_region() {
  RegionStmt out = region(true);
  if (accept_word("name")) out.text = string();
  return out;
}

FixtureBodyStmt Parser::fixture_shown() {
  ShownStmt out;
  out.link = name();
  expect_word("while");
  out.joint = name();
  out.from_below = at(TokenKind::kLessEqual);
  if (out.from_below) {
    advance();
  } else {
    expect(TokenKind::kGreaterEqual);
  }
  out.value = quantity();
  return out;
}

RegionStmt Parser::region(bool has_owner) {
  RegionStmt out;
  out.name = name();
  if (has_owner) {
    expect_word("of");
    out.of = name();
  }
  expect_word("box");
  out.low = point();
  expect(TokenKind::kDotDot);
  out.high = point();
  if (!accept_word("at")) return out;
  out.at = point();
  if (at_any_word({"roll", "pitch", "yaw"})) out.turn = pose();
  return out;
}

StartStmt Parser::joint_start(bool may_be_bound) {
  StartStmt out;
  const bool is_all = text_ahead(1) != ".";  // a fixture may be called so
  if (is_all && accept_word("none")) {
    out.none = true;
    return out;
  }
  out.fixture = name();
  expect(TokenKind::kDot);
  out.joint = name();
  if ((out.none = accept_word("none"))) return out;
  out.value = may_be_bound ? bound_quantity() : quantity();
  return out;
}

LayoutStmt Parser::layout_start() { return joint_start(false); }
TaskStmt Parser::task_start() { return joint_start(true); }

}  // namespace probe::syntax
