// Questions that a model is asked, and the placeholders inside their strings: "Is {the source} left
// of {the target}?". What may answer a question follows from its form.
#include "compiler/syntax/braces.h"

namespace probe::syntax {
namespace {

std::string read_placeholder(BraceWords& words, Placeholder& placeholder) {
  Name word;
  if (!words.take_word(word)) return "a name";
  if ((word.text == "the" || word.text == "a") && words.is_word_next()) {
    placeholder.article = word.text == "a" ? Placeholder::Article::kA : Placeholder::Article::kThe;
    words.take_word(word);
  }
  placeholder.of = word;
  if (words.is_word_next()) {
    Name of;
    words.take_word(of);
    if (of.text != "of") return "`of` or `}`";
    placeholder.what = word;
    if (!words.take_word(placeholder.of)) return "a name after `of`";
  }
  return words.is_at_end() ? "" : "`}`";
}

}  // namespace

DeclNode Parser::questions_decl() {
  static constexpr Rule<QuestionStmt> kRules[] = {
#define PROBE_IN_QUESTIONS(word, parse, repeat) {#word, &Parser::parse},
#include "compiler/syntax/keywords.def"
  };
  advance();
  QuestionsDecl out;
  out.name = name();
  out.body = body<QuestionStmt>(kRules, "a form of question");
  return out;
}

template <plan::QuestionForm form>
QuestionStmt Parser::question() {
  QuestionStmt out;
  out.form = form;
  out.name = name();
  out.text = question_text();
  if (accept_word("for")) {
    out.binder = name();
    expect_word("in");
    out.over = object_pool();
  }
  if (accept_word("at")) {
    if (accept_word("end")) {
      out.moment = plan::QuestionMoment::kEnd;
    } else {
      expect_word("start");
    }
  }
  expect_word("answer");
  const std::uint32_t begin = mark();
  out.answer = answer(form);
  out.answer_span = since(begin);
  if (form == plan::QuestionForm::kChoice) {
    expect_word("among");
    out.among = object_pool();
  }
  if (accept_word("pixels")) out.pixels = integer();
  if (accept_word("where")) out.where = cond();
  return out;
}

QuestionText Parser::question_text() {
  QuestionText out;
  out.text = string();
  braced_text<Placeholder>(out.text, out.parts, "a placeholder",
                           "a placeholder is `{instruction}`, `{source}`, `{the phrase of "
                           "target}`, `{category of source}` or `{a o}`",
                           read_placeholder);
  return out;
}

ObjectPool Parser::object_pool() {
  ObjectPool out;
  const std::uint32_t begin = mark();
  if (accept_word("catalogue")) {
    out.is_catalogue = true;
  } else if (expect_word("objects") && accept_word("and")) {
    out.absent = integer();
    expect_word("absent");
  }
  out.span = since(begin);
  return out;
}

// A `(` that touches the word before it.
void Parser::open_call() {
  set_role(TokenRole::kTightParen);
  expect(TokenKind::kLeftParen);
}

Answer Parser::answer(plan::QuestionForm form) {
  switch (form) {
    case plan::QuestionForm::kChoice:
    case plan::QuestionForm::kPoint:
      return AnswerOne{name()};
    case plan::QuestionForm::kYesNo:
      return yesno_answer();
    case plan::QuestionForm::kNumber: {
      AnswerCount out;
      expect_word("count");
      open_call();
      out.attribute = name();
      expect_word("of");
      out.who = name();
      expect(TokenKind::kRightParen);
      return out;
    }
    case plan::QuestionForm::kFree: {
      AnswerMentions out;
      expect_word("mentions");
      open_call();
      out.what = name();
      expect(TokenKind::kComma);
      out.to = name();
      expect(TokenKind::kRightParen);
      return out;
    }
  }
  return AnswerOne{};
}

Answer Parser::picture_answer() {
  if (accept_word("present")) {
    AnswerPresent out;
    open_call();
    out.who = name();
    expect(TokenKind::kRightParen);
    return out;
  }
  AnswerBeside out;
  out.is_nearer = accept_word("nearer");
  if (!out.is_nearer) expect_word("left");
  open_call();
  out.a = name();
  expect(TokenKind::kComma);
  out.b = name();
  expect(TokenKind::kRightParen);
  return out;
}

// Any condition can be judged; what is read off the picture is called as a predicate would be.
Answer Parser::yesno_answer() {
  const bool is_call = kind_ahead(1) == TokenKind::kLeftParen;
  if (is_call && at_any_word({"present", "left", "nearer"})) return picture_answer();
  return AnswerTruth{expr()};
}

}  // namespace probe::syntax
