// Suites.
#include "compiler/syntax/parser_impl.h"

namespace probe::syntax {

DeclNode Parser::suite_decl() {
  static constexpr Rule<SuiteStmt> kRules[] = {
#define PROBE_IN_SUITE(word, parse, repeat) {#word, &Parser::parse},
#include "compiler/syntax/keywords.def"
  };
  advance();
  SuiteDecl out;
  out.name = name();
  if (accept_word("trained")) {
    expect_word("on");
    out.trained_on = name();
  }
  out.body = body<SuiteStmt>(kRules, "a statement of `suite`");
  return out;
}

SuiteStmt Parser::suite_tasks() { return SuiteTasksStmt{{}, task_set()}; }

SuiteStmt Parser::suite_sample() {
  SuiteSampleStmt out;
  out.count = integer();
  expect_word("episodes");
  sample_of(out);
  return out;
}

SuiteStmt Parser::suite_prefix() { return PrefixStmt{{}, string()}; }

SuiteStmt Parser::suite_seeds() {
  return SeedsStmt{{}, comma_list([this] { return integer(); })};
}

SuiteStmt Parser::suite_expect() {
  ExpectTasksStmt out;
  out.tasks = integer();
  expect_word("tasks");
  expect(TokenKind::kComma);
  out.episodes = integer();
  expect_word("episodes");
  return out;
}

SuiteStmt Parser::suite_questions() { return SuiteQuestionsStmt{{}, names()}; }

}  // namespace probe::syntax
