// An answer is never guessed: what a lenient rule takes one from holds nothing that speaks against
// it, and the order of the options changes no reading.
#include <doctest/doctest.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/ask/reading/mentions.h"
#include "tests/runtime/ask/reading/reading.h"

namespace probe::ask {
namespace {

using plan::QuestionForm;

void replace(std::string& text, std::string_view what, std::string_view by) {
  for (std::size_t at = text.find(what); at != text.npos; at = text.find(what, at + by.size()))
    text.replace(at, what.size(), by);
}

// The reading of a pattern in each order of the options: {R} is the letter of the carrot, {RN} its
// name, {W} and {WN} those of the plate.
std::vector<std::string> in_all_orders(std::string_view pattern) {
  std::vector<std::string> out;
  ReadContext context = context_of(QuestionForm::kChoice);
  context.question = "A robot is told to clean up. Which object must it pick up?";
  for (std::size_t order = 0; order < context.options.size(); ++order) {
    const auto letter = [&](std::string_view name) {
      const auto at = std::ranges::find(context.options, name, &ShownOption::name);
      return std::string(1, static_cast<char>('A' + (at - context.options.begin())));
    };
    std::string raw(pattern);
    replace(raw, "{R}", letter("carrot"));
    replace(raw, "{RN}", "carrot");
    replace(raw, "{W}", letter("plate"));
    replace(raw, "{WN}", "plate");
    out.push_back(in_short(read_answer(context, raw)));
    std::rotate(context.options.begin(), context.options.begin() + 1, context.options.end());
  }
  return out;
}

void check_all(const std::vector<const char*>& patterns, const std::string& wanted) {
  for (const char* pattern : patterns) {
    CAPTURE(pattern);
    for (const std::string& read : in_all_orders(pattern)) CHECK(read == wanted);
  }
}

std::string read_of(QuestionForm form, const std::string& raw) {
  return in_short(read_answer(context_of(form), raw));
}

}  // namespace

TEST_CASE("a letter with its name and another that is denied is read alike in every order") {
  check_all(
      {"{R}. {RN}.\n\n{W}. {WN} is not what is meant.", "{R}. {RN}.\n\n{W}. {WN} is not mentioned.",
       "{R}) {RN} - it must be picked up; {W}) {WN} is where it goes."},
      "option 7");
  check_all({"{R}. {RN}\n{W}. {WN}", "{R}) {RN}: irrelevant\n{W}) {WN}: this is the one",
             "{R}. {RN} is where it lies. {W}. {WN} is the one.", "{R} vs {W}", "{R} then {W}",
             "{R} looks plausible, however {W} is better.", "{R} over {W}", "{R} can be discarded"},
            "unclear");
}

TEST_CASE("a choice that the rest of the answer speaks against is unclear") {
  check_all({"Not: {R}",
             "{R} is out.",
             "I don't think the answer is {R}.",
             "One might think that the answer is {R}.\nBut it is {W}.",
             "I doubt the answer is {R}.",
             "Nobody says that the answer is {R}.",
             "I can't say whether the answer is {R}.",
             "At first glance the answer is {R}. Looking closer, it is {W}.",
             "My first answer is {R}, on reflection {W}.",
             "{R} was my first thought, but {W} is right.",
             "{R}... hmm, {W}.",
             "{R}. Oops, {W}.",
             "The worst answer is {R}",
             "The least likely answer is {R}",
             "One tempting choice is {R}",
             "{R} is a trap.",
             "Discard {R}.",
             "{R}: 30%\n{W}: 70%",
             "Picture {R} shows it",
             "\u274c {R}",
             "{R} \u2717",
             "\u2612 {R}",
             "\u2260 {R}",
             "!= {R}",
             "\\boxed{\\neg {R}}",
             "\\cancel{{R}}",
             "<s>{R}</s>",
             "<del>{R}</del>",
             "{R} \U0001f44e",
             "- [ ] {R}\n- [x] {W}",
             "Nicht {R}",
             "Ce n'est pas {R}",
             "Non \u00e8 {R}",
             "\u4e0d\u662f {R}",
             "\u041d\u0435 {R}",
             "{R} ist falsch.",
             "[{\"answer\": \"{R}\"}, {\"answer\": \"{W}\"}]",
             "{\"answer\": \"{R}\"} {\"answer\": \"{W}\"}",
             "{\"answer\": \"{R}\"}\n\nWait, I mean {W}.",
             "{\"not\": \"{R}\"}",
             "It lies on the {RN}.",
             "The object next to the {RN}",
             "something like a {RN}",
             "Leave the {RN}.",
             "The {RN} is a distractor."},
            "unclear");
  check_all({"\\boxed{{R}}", "<answer>{R}</answer>", "{\"answer\": \"{R}\"}", "**{R}**",
             "The answer is ({R})", "The most likely answer is {R}.",
             "It is not easy.\nThe final answer is $\\boxed{{R}}$. I hope it is correct.",
             "```json\n{\"answer\": \"{R}\", \"reason\": \"the {WN} is not it\"}\n```",
             "**Answer:** {R}\n\n**Explanation:** Option {W} is wrong.",
             "{R}\n\nThe {WN} is not meant.", "The right answer is {R} because {W} is not it.",
             "Sure! The answer is {R}.", "I would go with option {R}.", "{RN} ({R})"},
            "option 7");
}

TEST_CASE("yes and no with a share, a question mark, a verb or a contradiction are unclear") {
  for (const char* raw :
       {"Yes?", "{\"yes\": 0.1}", "Yes: 10%", "Yes is wrong.", "\"No\" is not right.", "No, it is.",
        "No, there is.", "No, I can see it clearly.", "No, wrong, I see it.", "No. 1",
        "Nobody would say yes", "I refuse to say yes", "To say yes would be wrong",
        "That is correct", "\u274c Yes", "~~Yes~~", "One might think the answer is yes.\nIt isn't.",
        "I doubt the answer is yes", "If the answer is yes, then it would stand there."}) {
    CAPTURE(raw);
    CHECK(read_of(QuestionForm::kYesNo, raw) == "unclear");
  }
  for (const char* raw : {"No, I cannot tell from the picture.", "No, I don't know.",
                          "No, there is no image attached.", "No, it cannot be determined."}) {
    CAPTURE(raw);
    CHECK(read_of(QuestionForm::kYesNo, raw) == "refused");
  }
  for (const char* raw : {"No, there isn't one visible in this image.", "No, I don't see it.",
                          "No. I can see no such thing in the picture."}) {
    CAPTURE(raw);
    CHECK(read_of(QuestionForm::kYesNo, raw) == "no");
  }
  CHECK(read_of(QuestionForm::kYesNo, "I can see it, so the answer is yes.") == "yes");
}

TEST_CASE("a number that words or signs qualify is no count") {
  for (const char* raw : {"\u22483",
                          "\u22653",
                          ">= 3",
                          "< 3",
                          "\u2260 3",
                          "approx. 3",
                          "max. 3",
                          "up to 3",
                          "above 3",
                          "circa 3",
                          "3 or so",
                          "3-ish",
                          "3 percent",
                          "negative 3",
                          "- 3",
                          "2*2",
                          "2 x 2",
                          "3 - 3",
                          "\u2083",
                          "\u2462",
                          "Not: 3",
                          "perhaps 3",
                          "page 3",
                          "I am 3 years old",
                          "I see 3 plates but no carrot.",
                          "in one corner",
                          "One cannot say.",
                          "1. carrot on the left\n1. carrot on the right",
                          "{\"min\": 3}",
                          "I don't think the answer is 3",
                          "One might say the answer is 3.\nIt is 4."}) {
    CAPTURE(raw);
    CHECK(read_of(QuestionForm::kNumber, raw) == "unclear");
  }
  for (const char* raw :
       {"There are 2 objects of that kind.", "I can see 2 of them in the picture.", "**Count: 2**",
        "In the picture there are 2.", "I count 2."}) {
    CAPTURE(raw);
    CHECK(read_of(QuestionForm::kNumber, raw) == "2");
  }
}

TEST_CASE("a point in other units or frames, or one that is denied, is unclear") {
  for (const char* raw :
       {"normalized (120, 45)", "(250, 300) on a scale of 1000", "[250, 300]/1000", "(120, 45) mm",
        "(120, 45) relative to the center", "(120, 45) with the origin at the bottom",
        "(120, 45) measured from the bottom left of the picture", "(0, 1.0)", "(~120, ~45)",
        "Not: (120, 45)", "(120, 45) is wrong", "It is not visible. (0, 0)", "(120, 45) \u274c",
        "The size is (120, 45).", "I don't think the answer is (120, 45)"}) {
    CAPTURE(raw);
    CHECK(read_of(QuestionForm::kPoint, raw) == "unclear");
  }
  CHECK(read_of(QuestionForm::kPoint, "The center is around (320, 240) in the 640x480 picture.") ==
        "320 240");
}

TEST_CASE("thoughts in the marks of any model hold no answer") {
  for (const char* raw :
       {"\u25c1think\u25b7The answer is A.\nhm\u25c1/think\u25b7B",
        "[THINK]The answer is A.[/THINK]B", "<|START_THINKING|>The answer is A.<|END_THINKING|>B",
        "<seed:think>The answer is A.</seed:think>B", "<analysis>The answer is A.</analysis>B",
        "<think type=\"long\">The answer is A.</think>B",
        "<|channel|>analysis<|message|>The answer is A.<|end|><|start|>assistant<|channel|>final"
        "<|message|>B"}) {
    CAPTURE(raw);
    CHECK(read_of(QuestionForm::kChoice, raw) == "option 5");
  }
  for (const char* raw : {"\u25c1think\u25b7The answer is A.", "[THINK]The answer is A.",
                          "<|channel|>analysis<|message|>The answer is A.<|end|>"}) {
    CAPTURE(raw);
    CHECK(read_of(QuestionForm::kChoice, raw) == "empty");
  }
}

TEST_CASE("an answer that was cut off is read only from a place whose end is there") {
  const ReadContext context = context_of(QuestionForm::kChoice);
  for (const char* finish : {"length", "content_filter"}) {
    for (const char* raw :
         {"B", "The answer is B", "<answer>B", "{\"answer\": \"B\"", "\\boxed{B"}) {
      CAPTURE(raw);
      CHECK(read_answer(context, raw, finish).verdict == Verdict::kUnclear);
      CHECK(read_answer(context, raw, finish).rule == kCutRule);
      CHECK(in_short(read_answer(context, raw, "stop")) == "option 5");
    }
    for (const char* raw : {"\\boxed{B} since", "<answer>B</answer>", "{\"answer\": \"B\"}"}) {
      CAPTURE(raw);
      CHECK(in_short(read_answer(context, raw, finish)) == "option 5");
    }
  }
}

TEST_CASE("a restatement is a command or what has to be done, and nothing else") {
  const std::vector<ShownOption> options = {{7, "carrot", {}}, {5, "plate", {}}, {3, "towel", {}}};
  const auto is_right = [&](const char* raw) {
    return restate({options, 7, 5, "put carrot on plate"}, raw).right;
  };
  for (const char* raw : {"There is a carrot on the plate.",
                          "A picture of a carrot on a plate.",
                          "I see a carrot on the plate",
                          "The carrot is already on the plate.",
                          "A carrot is sitting on a plate",
                          "Put the carrot on the plate?",
                          "It is forbidden to put the carrot on the plate.",
                          "Put the carrot anywhere but on the plate.",
                          "Put the carrot on anything other than the plate.",
                          "The robot should fail to put the carrot on the plate.",
                          "Put the carrot on the other side of the plate.",
                          "Move the carrot over the plate onto the floor",
                          "Cut the carrot on the plate.",
                          "Describe the carrot on the plate.",
                          "Look at the carrot on the plate",
                          "Pick up the carrot on the plate.",
                          "Put nothing on the plate, take the carrot.",
                          "Put the carrot on the plate and put it back on the table.",
                          "Put the carrot on the plate or on the floor.",
                          "Put the carrot and the cup on the plate.",
                          "Put the carrot into the plate's box"}) {
    CAPTURE(raw);
    CHECK_FALSE(is_right(raw));
  }
  for (const char* raw :
       {"Pick up the carrot and place it on the plate, then release it.",
        "Place the carrot on the plate and then let go.",
        "Pick up the carrot without touching the towel and place it on the plate.",
        "The robot has to put the carrot on the plate.", "Carrot on plate",
        "The carrot should end up on the plate.", "Get the carrot onto the plate",
        "Put the carrot onto the plate's surface."}) {
    CAPTURE(raw);
    CHECK(is_right(raw));
  }
}

TEST_CASE("a terminal's colours around an answer are no words of it") {
  const ReadContext choice = context_of(QuestionForm::kChoice);
  CHECK(in_short(read_answer(choice, "\x1b[31mB\x1b[0m")) == "option 5");
  CHECK(in_short(read_answer(choice, "\x1b[1;31m<b>B</b>")) == "option 5");
  CHECK(in_short(read_answer(choice, "[31m B")) == "unclear");
  const Reading count =
      read_answer(context_of(QuestionForm::kNumber), "\x1b[38;5;196mthree\x1b[0m");
  CHECK(count.number == 3);
}

}  // namespace probe::ask
