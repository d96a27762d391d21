// Answers that a rule takes for one and that deny, hedge or contradict it: they are unclear.
#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "tests/runtime/ask/reading/reading.h"

namespace probe::ask {
namespace {

using plan::QuestionForm;

std::string short_of(QuestionForm form, const std::string& raw, const char* question = nullptr) {
  ReadContext context = context_of(form);
  if (question != nullptr) context.question = question;
  return in_short(read_answer(context, raw));
}

}  // namespace

TEST_CASE("a choice that is denied, rejected, asked back or taken back is unclear") {
  for (const char* raw : {"B is incorrect.",
                          "Option B is not the object it must pick up.",
                          "B) is not in the picture, so I choose the plate.",
                          "B is the one it must leave alone",
                          "B\n\nB is wrong actually",
                          "C can be ruled out.",
                          "A is wrong; C is right.",
                          "A is not what it must pick up. It must pick up C.",
                          "A: No\nB: Yes\nC: No\nD: No",
                          "(A) no (B) no (C) no (D) yes",
                          "A - no\nC - yes",
                          "{\"A\": false, \"B\": true}",
                          "A? No, B.",
                          "**A** is the target, **C** is the source",
                          "The wrong answer is A.",
                          "Incorrect option: B.",
                          "I would eliminate C first",
                          "The opposite of B",
                          "Is it A?",
                          "~~B~~",
                          "!C",
                          "The carrot is not visible in the image.",
                          "The carrot isn't the object that it must pick up.",
                          "The carrot should be left alone.",
                          "It must leave alone the carrot",
                          "Anything besides the carrot",
                          "Everything other than the carrot",
                          "Carrot or banana",
                          "The carrot or something else",
                          "The plate. No, the carrot",
                          "B and also C",
                          "B then C",
                          "B is least likely",
                          "All but B",
                          "None of them, but B is closest",
                          "None of these. B",
                          "Neither, but if I have to say: B",
                          "B is closest",
                          "B comes close",
                          "A-B",
                          "A-C",
                          "A B",
                          "A B-shaped object",
                          "B is correct; the others are wrong, and C is wrong",
                          "A is wrong; the others are correct",
                          "The others are wrong, B is wrong, too"}) {
    CAPTURE(raw);
    CHECK(short_of(QuestionForm::kChoice, raw) == "unclear");
  }
  for (const char* raw :
       {"B", "(B)", "B.", "B) plate", "B. Because the plate is not what it needs",
        "The answer is (B)", "B. No other object is round.", "B is correct; the others are wrong",
        "B. All other options are wrong.", "It is B, because the others are incorrect.",
        "The others are wrong, so it is B.", "B, none of the others is round.",
        "B is closest to the gripper"}) {
    CAPTURE(raw);
    CHECK(short_of(QuestionForm::kChoice, raw) == "option 5");
  }
}

TEST_CASE("yes and no that are hedged, contradicted or about another noun are unclear") {
  const char* side = "Is the carrot to the left of the plate?";
  for (const char* raw :
       {"No doubt, the carrot is left of the plate.", "No objects block the view: it is left.",
        "No question about it: it is.", "No need to think: yes.", "No, wait, yes",
        "There is a plate to the left of the carrot.", "There is a carrot.", "There is no plate.",
        "Yes, it is not.", "No. The carrot is to the left.", "yes, the carrot is on the right",
        "Correct, the carrot is not left of it.", "Maybe yes", "If you mirror the image, yes.",
        "Yes if seen from behind"}) {
    CAPTURE(raw);
    CHECK(short_of(QuestionForm::kYesNo, raw, side) == "unclear");
  }
  CHECK(short_of(QuestionForm::kYesNo, "Yes, it is to the left of the plate.", side) == "yes");
  CHECK(short_of(QuestionForm::kYesNo, "No, it is to the right of it.", side) == "no");
  CHECK(short_of(QuestionForm::kYesNo, "No, it is not to the left of it.", side) == "no");
  // Whether there is a carrot on the table:
  CHECK(short_of(QuestionForm::kYesNo, "Yes, there is no carrot") == "unclear");
  CHECK(short_of(QuestionForm::kYesNo, "No other objects but the asked one are there.") ==
        "unclear");
  CHECK(short_of(QuestionForm::kYesNo, "I do not see it.") == "no");
  CHECK(short_of(QuestionForm::kYesNo, "I don't see a carrot.") == "no");
  CHECK(short_of(QuestionForm::kYesNo, "I do not see a picture.") == "refused");
  CHECK(short_of(QuestionForm::kYesNo, "I do not see it.", side) == "refused");
}

TEST_CASE("a number word that counts nothing and a number with a sign of doubt are unclear") {
  for (const char* raw : {"One can see a carrot and a tomato.", "The orange one and the red one.",
                          "a carrot and another one", "a couple: one orange and one red",
                          "none, one would say", "thirty-one", "3?", "1+", "~1", "1\u00b2",
                          "one of them", "One of them is orange.", "One of the carrots."}) {
    CAPTURE(raw);
    CHECK(short_of(QuestionForm::kNumber, raw) == "unclear");
  }
  CHECK(short_of(QuestionForm::kNumber, "There is one.") == "1");
  CHECK(short_of(QuestionForm::kNumber, "one carrot") == "1");
  CHECK(short_of(QuestionForm::kNumber, "Only one of them is a carrot.") == "1");
}

TEST_CASE("a point with a size, per cent, a range, y before x or a denial is unclear") {
  for (const char* raw :
       {"{\"x\": 120, \"y\": 40, \"width\": 30, \"height\": 20}", "x=120, y=40, w=30, h=20",
        "(50%, 25%)", "x: 50%, y: 25%", "x: 120-140, y: 45", "(y, x) = (45, 123)",
        "not at (320, 240)", "(row, col) = (3, 4)", "top left: (1,2)", "Top-left (1, 2)",
        "upper left corner: (120, 45)", "The bottom right corner of the carrot is at (123, 45)."}) {
    CAPTURE(raw);
    CHECK(short_of(QuestionForm::kPoint, raw) == "unclear");
  }
  CHECK(short_of(QuestionForm::kPoint, "(x, y) = (123, 45)") == "123 45");
}

}  // namespace probe::ask
