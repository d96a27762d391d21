#include <doctest/doctest.h>

#include "tests/compiler/syntax/parse_helper.h"

using namespace probe;
using namespace probe::syntax;

TEST_CASE("a question has a form, a name, a text with placeholders and an answer") {
  const Parsed parsed(R"(questions q {
  choice pick "\"{instruction}\": which of {the phrase of source} and {a o}?" for o in objects and 2 absent at start answer o among catalogue pixels 9 where not has distractors
  yesno up "up?" at end answer height(source) > 2cm where uses action
  number many "how many?" answer count(category of source)
}
suite s { tasks tasks; seeds 1; questions q, r })");
  CHECK(parsed.messages() == "");
  const auto& questions = parsed.get<QuestionsDecl>();
  REQUIRE(questions.body.size() == 3);
  const QuestionStmt& pick = questions.body[0];
  CHECK(pick.form == plan::QuestionForm::kChoice);
  CHECK(pick.name.text == "pick");
  REQUIRE(pick.text.parts.size() == 7);
  CHECK(std::get<std::string>(pick.text.parts[0]) == "\"");
  CHECK(as<Placeholder>(pick.text.parts[1]).of.text == "instruction");
  const auto& phrase = as<Placeholder>(pick.text.parts[3]);
  CHECK(phrase.article == Placeholder::Article::kThe);
  CHECK(phrase.what->text == "phrase");
  CHECK(phrase.of.text == "source");
  CHECK(parsed.text(phrase.span) == "{the phrase of source}");
  CHECK(as<Placeholder>(pick.text.parts[5]).article == Placeholder::Article::kA);
  CHECK(pick.binder->text == "o");
  CHECK(pick.over.absent->value == 2);
  CHECK(pick.among->is_catalogue);
  CHECK(pick.pixels->value == 9);
  CHECK(pick.where.has_value());
  CHECK(std::holds_alternative<AnswerTruth>(questions.body[1].answer));
  CHECK(questions.body[1].moment == plan::QuestionMoment::kEnd);
  CHECK(as<AnswerCount>(questions.body[2].answer).who.text == "source");
  CHECK(as<SuiteQuestionsStmt>(parsed.get<SuiteDecl>(1).body[2]).sets.size() == 2);
}

TEST_CASE("what a form cannot be answered by is said at the answer") {
  const auto said = [](const std::string& statement) {
    return Parsed("questions q {\n" + statement + "\n}\n").messages();
  };
  CHECK(said(R"(choice a "x" answer source)").find("`among`") != std::string::npos);
  CHECK(said(R"(number a "x" answer 3)").find("`count`") != std::string::npos);
  CHECK(said(R"(free a "x" answer mentions(source))") != "");
  CHECK(said(R"(riddle a "x" answer source)").find("`choice`") != std::string::npos);
  CHECK(said(R"(point a "{the phrase source}" answer source)").find("`of` or `}`") !=
        std::string::npos);
  CHECK(said(R"(point a "{}" answer source)").find("a placeholder is") == std::string::npos);
  CHECK(said(R"(point a "{phrase of}" answer source)").find("a name after `of`") !=
        std::string::npos);
}
