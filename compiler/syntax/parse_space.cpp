// Spaces of variants.
#include "compiler/syntax/parser_impl.h"

namespace probe::syntax {

DeclNode Parser::space_decl() {
  static constexpr Rule<SpaceStmt> kRules[] = {
#define PROBE_IN_SPACE(word, parse, repeat) {#word, &Parser::parse},
#include "compiler/syntax/keywords.def"
  };
  advance();
  SpaceDecl out;
  out.name = name();
  expect_word("of");
  out.of = name();
  out.body = body<SpaceStmt>(kRules, "a statement of `space`");
  return out;
}

SpaceRange Parser::space_range() {
  SpaceRange out;
  out.low = quantity();
  expect(TokenKind::kDotDot);
  out.high = quantity();
  return out;
}

void Parser::space_ranges(
    std::initializer_list<std::pair<std::string_view, std::optional<SpaceRange>*>> known,
    std::optional<Quantity>* direction) {
  do {
    bool found = false;
    for (const auto& [word, to] : known) {
      if (*to || !accept_word(word)) continue;
      *to = space_range();
      found = true;
      break;
    }
    if (found) continue;
    if (direction != nullptr && !*direction && accept_word("direction")) {
      expect_word("within");
      *direction = quantity();
      continue;
    }
    std::string words;
    for (const auto& [word, to] : known)
      words += (words.empty() ? "`" : ", `") + std::string(word) + " A .. B`";
    if (direction != nullptr) words += ", `direction within A`";
    fail(Code::P0101, here(), "expected " + words + ", each once");
    return;
  } while (accept(TokenKind::kComma));
}

SpaceStmt Parser::space_light() {
  SpaceLightStmt out;
  space_ranges({{"ambient", &out.ambient}, {"power", &out.power}}, &out.direction);
  return out;
}

SpaceStmt Parser::space_camera() {
  SpaceCameraStmt out;
  out.view = name();
  expect_word("within");
  do {
    if (!out.place && !out.turn && at(TokenKind::kLeftParen)) {
      out.place = point();
    } else {
      out.turn = quantity();
      break;
    }
  } while (accept(TokenKind::kComma));
  return out;
}

SpaceStmt Parser::space_place() {
  SpacePlaceStmt out;
  out.discs = comma_list([this] {
    SpacePlaceStmt::Disc disc;
    disc.what = name();
    expect_word("in");
    expect_word("disc");
    disc.radius = quantity();
    return disc;
  });
  return out;
}

SpaceStmt Parser::space_clutter() {
  SpaceClutterStmt out;
  out.least = integer();
  expect(TokenKind::kDotDot);
  out.most = integer();
  expect_word("from");
  expect(TokenKind::kLeftParen);
  out.from = names();
  expect(TokenKind::kRightParen);
  return out;
}

SpaceStmt Parser::space_words() {
  SpaceWordsStmt out;
  out.pools = comma_list([this] {
    SpaceWordsStmt::Pool pool;
    pool.is_templates = accept_word("templates");
    if (!pool.is_templates) expect_word("phrases");
    expect_word("of");
    pool.of = name();
    return pool;
  });
  return out;
}

SpaceStmt Parser::space_sensor() {
  SpaceSensorStmt out;
  space_ranges({{"noise", &out.noise}, {"blur", &out.blur}, {"exposure", &out.exposure}});
  return out;
}

SpaceStmt Parser::space_delay() { return SpaceDelayStmt{{}, space_range()}; }

}  // namespace probe::syntax
