// Layouts: where things stand at the start.
#include "compiler/syntax/parser_impl.h"

namespace probe::syntax {

DeclNode Parser::layout_decl() {
  static constexpr Rule<LayoutStmt> kRules[] = {
#define PROBE_IN_LAYOUT(word, parse, repeat) {#word, &Parser::parse},
#include "compiler/syntax/keywords.def"
  };
  advance();
  LayoutDecl out;
  out.name = name();
  out.like = optional_name_after("like");
  out.body = body<LayoutStmt>(kRules, "a statement of `layout`");
  return out;
}

LayoutStmt Parser::layout_cells() {
  CellsStmt out;
  out.name = name();
  expect(TokenKind::kAssign);
  expect_word("grid");
  out.nx = integer();
  expect_word("x");
  out.ny = integer();
  expect_word("at");
  out.at = point();
  expect_word("spread");
  out.spreads = comma_list([this] { return point(); });
  return out;
}

LayoutStmt Parser::layout_place() {
  std::vector<Name> what = names();
  if (accept_word("at")) {
    PlaceAtStmt out;
    out.names = std::move(what);
    out.at = point();
    return out;
  }
  const bool on = accept_word("on");
  if (!on) expect_word("in");
  if (!on && kind_ahead(1) == TokenKind::kIdent && at_any_word({"distinct", "remaining"})) {
    PlaceInStmt out;
    out.names = std::move(what);
    out.how = accept_word("remaining") ? PlaceHow::kRemaining : PlaceHow::kDistinct;
    accept_word("distinct");
    out.cells = name();
    return out;
  }
  PlaceOnStmt out;
  out.names = std::move(what);
  out.in = !on;
  out.where = thing();
  return out;
}

LayoutStmt Parser::layout_orient() {
  if (at_word("by") && text_ahead(1) == "rest") {
    advance();
    expect_word("rest");
    return OrientByRestStmt{};
  }
  OrientStmt out;
  out.what = name();
  out.poses = poses();
  return out;
}

LayoutStmt Parser::layout_starts() { return StartsStmt{{}, string(), {}}; }

LayoutStmt Parser::layout_jitter() { return JitterStmt{{}, quantity()}; }

LayoutStmt Parser::layout_joints() {
  expect_word("jitter");
  return JointsJitterStmt{{}, quantity()};
}

LayoutStmt Parser::layout_drop() {
  DropStmt out;
  out.none = accept_word("none");
  if (out.none) return out;
  out.height = quantity();
  if (accept_word("settle")) out.settle = quantity();
  return out;
}

LayoutStmt Parser::layout_expect() {
  ExpectEpisodesStmt out;
  out.episodes = integer();
  expect_word("episodes");
  return out;
}

}  // namespace probe::syntax
