// Whoever changes how a text is read raises the version of the reader: rows of older folders are
// then read anew and not taken for changed.
#include <doctest/doctest.h>

#include <string>

#include "runtime/base/sha256.h"
#include "runtime/plan/questions.h"
#include "tests/runtime/ask/reading/reading.h"

namespace probe::ask {
namespace {

constexpr const char* kSaid[] = {
    "B",
    "(b)",
    "**B**",
    "E",
    "B) plate",
    "A. plate",
    "B or C",
    "A-B",
    "The answer is (B)",
    "<answer>B</answer>",
    "\\boxed{B}",
    "{\"answer\": \"B\"}",
    "Let me see.\nB",
    "I think it is (B)",
    "B is correct; the others are wrong",
    "None of them, but B is closest",
    "B is not the one",
    "carrot",
    "The carrot.",
    "the orange object",
    "the basket",
    "It is the carrot, not the plate",
    "Carrot or plate",
    "I cannot see a picture.",
    "<think>A or B?</think>B",
    "",
    "Yes.",
    "no",
    "Yes and no",
    "No, there is none.",
    "There is a carrot.",
    "It does not.",
    "The carrot is there, so yes.",
    "No doubt, it is.",
    "Maybe yes",
    "I do not see it.",
    "3",
    "three",
    "There are 3 of them.",
    "3 or 4",
    "about 3",
    "one of them",
    "Only one of them is a carrot.",
    "There are no carrots.",
    "1+",
    "(120, 45)",
    "x=120, y=45",
    "[0.2, 0.4]",
    "top left: (1,2)",
    "<loc0512><loc0256>",
    "<point x=\"120\" y=\"45\">",
    "120 45",
    "Put the carrot on the plate.",
    "Put the orange object on the plate.",
    "Put the carrot beside the plate.",
    "Do not put the carrot on the plate.",
    "Not: B",
    "I doubt the answer is B",
    "B. plate\nA. carrot is not meant",
    "{\"answer\": \"B\"}\nWait, A",
    "\u22483",
    "No, I cannot tell.",
    "No, it is.",
    "(120, 45) mm",
    "[THINK]A[/THINK]B",
};

TEST_CASE("how these texts are read is as this version of the reader reads them") {
  Hasher hasher;
  for (const plan::QuestionFormInfo& form : plan::kQuestionForms) {
    const AnswerReader reader(context_of(form.id));
    for (const char* said : kSaid) {
      const Reading reading = reader.read(said);
      hasher.text(said).text(in_short(reading)).text(reading.rule);
    }
  }
  CHECK(kReaderVersion == 4);
  CHECK_MESSAGE(
      to_hex(hasher.finish()) == "921338898ce4e0e1fb4697c095b1fbaeca1ab159559aa71bcd05865a441f8010",
      "raise kReaderVersion (answer_row.h), then write both here");
}

}  // namespace
}  // namespace probe::ask
