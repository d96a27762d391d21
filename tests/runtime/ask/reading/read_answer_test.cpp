#include "runtime/ask/reading/read_answer.h"

#include <doctest/doctest.h>

#include <chrono>
#include <set>
#include <string>
#include <vector>

#include "tests/runtime/ask/reading/reading.h"

namespace probe::ask {
namespace {

using plan::QuestionForm;

void check(QuestionForm form, const std::vector<Answered>& answers) {
  const ReadContext context = context_of(form);
  std::set<std::string> used;
  for (const Answered& answer : answers) {
    CAPTURE(answer.raw);
    const Reading reading = read_answer(context, answer.raw);
    CHECK(in_short(reading) == answer.read);
    CHECK(reading.rule == answer.rule);
    const std::size_t colon = reading.rule.rfind(": ");
    used.insert(colon == std::string::npos ? reading.rule : reading.rule.substr(colon + 2));
  }
  for (const RuleInfo& rule : rules(form)) {
    CAPTURE(rule.name);
    CHECK_MESSAGE(used.contains(std::string(rule.name)), "no answer of the table uses this rule");
    CHECK_FALSE(rule.says.empty());
  }
}

}  // namespace

TEST_CASE("a choice is read by its letter, then by names, and never guessed") {
  check(
      QuestionForm::kChoice,
      {
          // A letter and nothing else.
          {"B", "option 5", "letter alone"},
          {"b", "option 5", "letter alone"},
          {"(B)", "option 5", "letter alone"},
          {"B.", "option 5", "letter alone"},
          {"B)", "option 5", "letter alone"},
          {"[B]", "option 5", "letter alone"},
          {" B \n", "option 5", "letter alone"},
          {"**B**", "option 5", "letter alone"},
          {"*B*", "option 5", "letter alone"},
          {"__B__", "option 5", "letter alone"},
          {"`B`", "option 5", "letter alone"},
          {"\"B\"", "option 5", "letter alone"},
          {"'B'", "option 5", "letter alone"},
          {"\u201cB\u201d", "option 5", "letter alone"},
          {"\uff22", "option 5", "letter alone"},
          {"\u00a0B\u00a0", "option 5", "letter alone"},
          {"B\u200b", "option 5", "letter alone"},
          {"```\nB\n```", "option 5", "letter alone"},
          {"A", "option 7", "letter alone"},
          {"a", "option 7", "letter alone"},
          {"A.", "option 7", "letter alone"},
          {"Option B", "option 5", "letter alone"},
          {"option (b)", "option 5", "letter alone"},
          {"$B$", "option 5", "letter alone"},
          {"\\text{B}", "option 5", "letter alone"},
          {"B</s>", "option 5", "letter alone"},
          {"B<|im_end|>", "option 5", "letter alone"},
          {"<b>B</b>", "option 5", "letter alone"},
          {"E", "unclear", "letter alone"},
          {"I", "unclear", "letter alone"},
          {"Z.", "unclear", "letter alone"},
          // A letter first.
          {"B) plate", "option 5", "letter first"},
          {"B. plate", "option 5", "letter first"},
          {"B: plate", "option 5", "letter first"},
          {"B - plate", "option 5", "letter first"},
          {"B \u2014 the plate", "option 5", "letter first"},
          {"(B) plate", "option 5", "letter first"},
          {"B plate", "option 5", "letter first"},
          {"B, the plate", "option 5", "letter first"},
          {"**B) plate**", "option 5", "letter first"},
          {"**B.** The plate", "option 5", "letter first"},
          {"b) plate", "option 5", "letter first"},
          {"b. the plate", "option 5", "letter first"},
          {"A) carrot", "option 7", "letter first"},
          {"A. carrot", "option 7", "letter first"},
          {"A: the carrot", "option 7", "letter first"},
          {"A - carrot", "option 7", "letter first"},
          {"A\ncarrot", "option 7", "letter first"},
          {"A is correct", "option 7", "letter first"},
          {"A because it is the rabbit's favorite", "option 7", "letter first"},
          {"B\n\nThe carrot lies beside it.", "option 5", "letter first"},
          {"B. Because the carrot is not asked for.", "option 5", "letter first"},
          {"B, because (A) is the carrot", "option 5", "letter first"},
          {"C) orange juice", "option 2", "letter first"},
          {"D. yellow basket\n", "option 0", "letter first"},
          {"D. basket", "option 0", "letter first"},
          {"C. The drink rich in vitamin C", "option 2", "letter first"},
          {"B) carrot", "unclear", "letter first"},
          {"A. plate", "unclear", "letter first"},
          {"B. The carrot", "unclear", "letter first"},
          {"E) carrot", "unclear", "letter first"},
          {"F. none of these", "unclear", "letter first"},
          {"B or C", "unclear", "letter first"},
          {"B and C", "unclear", "letter first"},
          {"A and B", "unclear", "letter first"},
          {"A or B", "unclear", "letter first"},
          {"B, C", "unclear", "letter first"},
          {"B/C", "unclear", "letter first"},
          {"(A) or (B)", "unclear", "letter first"},
          {"A) carrot or B) plate", "unclear", "options repeated"},
          {"A. carrot\nB. plate\nC. orange juice\nD. yellow basket", "unclear", "options repeated"},
          {"A\nB", "unclear", "letter first"},
          {"B\nC\nD", "unclear", "letter first"},
          {"B\nB", "option 5", "letter first"},
          // A letter last.
          {"The rabbit's favorite food is meant.\nA", "option 7", "letter last"},
          {"Let me see.\n\n**B**", "option 5", "letter last"},
          {"Step 1: look.\nStep 2: think of carrot and plate.\n(B) plate", "option 5",
           "letter last"},
          {"I looked.\nE", "unclear", "letter last"},
          {"I looked.\nB) carrot", "unclear", "letter last"},
          // A letter in a sentence.
          {"I think it is (B).", "option 5", "letter in a sentence"},
          {"I would say B.", "option 5", "letter in a sentence"},
          {"It's B", "option 5", "letter in a sentence"},
          {"I choose option B", "option 5", "letter in a sentence"},
          {"The robot must pick up B", "option 5", "letter in a sentence"},
          {"It is the plate (B)", "option 5", "letter in a sentence"},
          {"I believe that option A is meant", "option 7", "letter in a sentence"},
          {"Clearly (a) fits", "option 7", "letter in a sentence"},
          {"It is the carrot (B)", "unclear", "letter in a sentence"},
          {"Either B or C would do", "unclear", "letter in a sentence"},
          {"It is not B", "unclear", "letter in a sentence"},
          {"I would go for E", "unclear", "letter in a sentence"},
          // Names.
          {"carrot", "option 7", "name alone"},
          {"Carrot.", "option 7", "name alone"},
          {"CARROT", "option 7", "name alone"},
          {"the carrot", "option 7", "name alone"},
          {"A carrot", "option 7", "name alone"},
          {"A carrot.", "option 7", "name alone"},
          {"An orange juice", "option 2", "name alone"},
          {"carrots", "option 7", "name alone"},
          {"\"carrot\"", "option 7", "name alone"},
          {"It is the carrot.", "option 7", "name alone"},
          {"yellow basket", "option 0", "name alone"},
          {"yellow_basket", "option 0", "name alone"},
          {"yellow-basket", "option 0", "name alone"},
          {"the basket", "option 0", "name alone"},
          {"The orange object", "option 7", "name alone"},
          {"rabbit\u2019s favorite vegetable", "option 7", "name alone"},
          {"orange juice", "option 2", "name alone"},
          {"carrot, carrot", "option 7", "name in a sentence"},
          {"Carrot. The plate is where it goes.", "option 7", "name as sentence"},
          {"The carrot, because the plate is yellow.", "option 7", "name as sentence"},
          {"We need the plate for it.\nCarrot", "option 7", "name as sentence"},
          {"Carrot.\nPlate.", "unclear", "name as sentence"},
          {"The robot must pick up the carrot.", "option 7", "name in a sentence"},
          {"I think the robot has to take a carrot!", "option 7", "name in a sentence"},
          {"pick up the orange juice", "option 2", "name in a sentence"},
          {"the drink that is rich: orange juice", "option 2", "name in a sentence"},
          {"put it on the basket", "option 0", "name in a sentence"},
          {"carrot and plate", "unclear", "two named"},
          {"carrot, plate", "unclear", "two named"},
          {"there a carrot on the table", "unclear", "question repeated"},
          {"It could be the carrot or the plate.", "unclear", "two named"},
          {"not the plate but the carrot", "unclear", "name denied"},
          {"It is not the carrot.", "unclear", "name denied"},
          {"Anything instead of the plate", "unclear", "name denied"},
          {"the towel", "unclear", "nothing that answers"},
          {"the orange", "unclear", "nothing that answers"},
          {"A towel", "unclear", "nothing that answers"},
          {"I am", "unclear", "nothing that answers"},
          {"...", "unclear", "nothing that answers"},
          {"\x01\x02", "empty", "blank"},
          // Places.
          {"Answer: B", "option 5", "answer line: letter alone"},
          {"answer: b", "option 5", "answer line: letter alone"},
          {"Answer B", "option 5", "letter alone"},
          {"ANSWER = (B)", "option 5", "answer line: letter alone"},
          {"The answer is (B)", "option 5", "answer line: letter alone"},
          {"The answer is B.", "option 5", "answer line: letter alone"},
          {"The correct option is B", "option 5", "answer line: letter alone"},
          {"The answer is:\n\n**B**", "option 5", "answer line: letter alone"},
          {"**Answer:** B", "option 5", "answer line: letter alone"},
          {"**Final Answer: (B)**", "option 5", "answer line: letter alone"},
          {"The carrot is orange. The plate is not. Answer: A", "option 7",
           "answer line: letter alone"},
          {"Answer: A carrot", "option 7", "answer line: name alone"},
          {"Answer: A. carrot", "option 7", "answer line: letter first"},
          {"The answer is a carrot", "option 7", "answer line: name alone"},
          {"The answer is B, the plate.", "option 5", "answer line: letter first"},
          {"Answer: B\nThe carrot is only there to distract.", "option 5",
           "answer line: letter alone"},
          {"The answer is not B", "unclear", "answer line: letter in a sentence"},
          {"The answer is B or C", "unclear", "answer line: letter first"},
          {"Answer: B\nAnswer: C", "unclear", "answer line: two answers"},
          {"Answer: B\nFinal answer: B", "option 5", "answer line: letter alone"},
          {"B is the right answer: the carrot lies on it", "option 5", "letter first"},
          {"<answer>B</answer>", "option 5", "tag: letter alone"},
          {"<ANSWER>B</ANSWER>", "option 5", "tag: letter alone"},
          {"<answer>B", "option 5", "tag: letter alone"},
          {"<answer>\nB. plate\n</answer>", "option 5", "tag: letter first"},
          {"carrot? plate? <answer>carrot</answer>", "option 7", "tag: name alone"},
          {"<answer></answer>", "empty", "tag: blank"},
          {"<answer>unsure</answer> B", "unclear", "tag: nothing that answers"},
          {"<answer>B</answer><answer>C</answer>", "unclear", "tag: two answers"},
          {"\\boxed{B}", "option 5", "box: letter alone"},
          {"$\\boxed{\\text{B}}$", "option 5", "box: letter alone"},
          {"The carrot is meant, so $\\boxed{A}$.", "option 7", "box: letter alone"},
          {"<answer>\\boxed{B}</answer>", "option 5", "tag: box: letter alone"},
          {"<|begin_of_box|>B<|end_of_box|>", "option 5", "box: letter alone"},
          {"{\"answer\": \"B\"}", "option 5", "json: letter alone"},
          {"```json\n{\"answer\": \"B\"}\n```", "option 5", "json: letter alone"},
          {"Sure! {\"Answer\": \"B) plate\"}", "option 5", "json: letter first"},
          {"{\"reason\": \"the plate is yellow\", \"answer\": \"carrot\"}", "option 7",
           "json: name alone"},
          {"[{\"answer\": [\"B\"]}]", "option 5", "json: letter alone"},
          {"{\"answer\": [\"B\", \"C\"]}", "unclear", "json: letter first"},
          {"{\"answer\": null}", "unclear", "json: nothing that answers"},
          {"{\"object\": \"carrot\"}", "option 7", "json: name alone"},
          {"{\"answer\": \"B\"", "option 5", "answer line: letter alone"},
          // Thoughts.
          {"<think>A or B?</think>B", "option 5", "letter alone"},
          {"<think>\nA?\n</think>\n\nB", "option 5", "letter alone"},
          {"hm, A or C</think>B", "option 5", "letter alone"},
          {"<thinking>A</thinking><answer>B</answer>", "option 5", "tag: letter alone"},
          {"<think>B", "empty", "thoughts alone"},
          {"<think>B</think>", "empty", "thoughts alone"},
          {"<THINK>A</THINK>B", "option 5", "letter alone"},
          // Nothing, or not willing.
          {"", "empty", "blank"},
          {"  \n\t ", "empty", "blank"},
          {"\u00a0\u3000", "empty", "blank"},
          {"I'm sorry, but I can't assist with that.", "refused", "refused"},
          {"I cannot see any image.", "refused", "refused"},
          {"I can\u2019t see the carrot in the picture.", "refused", "refused"},
          {"As an AI, I have no eyes.", "refused", "refused"},
          {"It cannot be determined from the picture.", "refused", "refused"},
          {"B. I cannot be sure, though.", "option 5", "letter first"},
          // Markup and controls are data.
          {"\x1b[31mB\x1b[0m", "option 5", "letter alone"},
          {"<script>alert(1)</script>", "unclear", "nothing that answers"},
          {"carrot\x07", "option 7", "name alone"},
          {"B\xff", "option 5", "letter alone"},
      });
}

TEST_CASE("who copies the question has not chosen, who names or describes in other words has") {
  ReadContext context = context_of(QuestionForm::kChoice);
  const auto read = [&](const std::string& raw) {
    const Reading reading = read_answer(context, raw);
    return in_short(reading) + ": " + reading.rule;
  };
  context.question = "Which object in the picture is the rabbit\u2019s favorite vegetable?";
  CHECK(read("rabbit's favorite vegetable") == "unclear: question repeated");
  CHECK(read("The rabbit's favorite vegetable.") == "unclear: question repeated");
  CHECK(read("It is the rabbit's favorite vegetable, of course") == "unclear: question repeated");
  CHECK(read("carrot") == "option 7: name alone");
  CHECK(read("The rabbit's favorite vegetable is the carrot.") == "option 7: name in a sentence");
  CHECK(read("the orange object") == "option 7: name alone");
  CHECK(read("Rabbit's favorite vegetable.\nIt lies beside the plate.") == "unclear: two named");
  CHECK(read("A. rabbit's favorite vegetable") == "option 7: letter first");
  CHECK(read("B. rabbit's favorite vegetable") == "unclear: letter first");

  context.question = "A robot is told: \"put the leafy thing on the plate\". Where must it put it?";
  CHECK(read("put the leafy thing on the plate") == "unclear: question repeated");
  CHECK(read("plate") == "option 5: name alone");
  CHECK(read("on the plate") == "option 5: name in a sentence");
  context.question = "A robot is told: \"put orange juice on the plate\". Which must it take?";
  CHECK(read("orange juice") == "option 2: name alone");
  CHECK(read("put orange juice on plate") == "unclear: question repeated");
}

TEST_CASE("without letters a letter is no answer and names are") {
  ReadContext context = context_of(QuestionForm::kChoice);
  context.letters = false;
  CHECK(in_short(read_answer(context, "B")) == "unclear");
  CHECK(in_short(read_answer(context, "the plate")) == "option 5");
}

TEST_CASE("a letter that two options' words follow is their first one's only if it is its own") {
  ReadContext context = context_of(QuestionForm::kChoice);
  context.options = {{0, "plate", {}}, {1, "small plate", {}}, {2, "orange", {}}};
  CHECK(in_short(read_answer(context, "small plate")) == "option 1");
  CHECK(in_short(read_answer(context, "plate")) == "option 0");
  CHECK(in_short(read_answer(context, "B. small plate")) == "option 1");
  CHECK(in_short(read_answer(context, "A. small plate")) == "unclear");
  CHECK(in_short(read_answer(context, "the orange")) == "option 2");
  // An adjective is no name.
  CHECK(in_short(read_answer(context, "the orange object")) == "unclear");
  context.options = {{0, "green cube", {}}, {1, "yellow cube", {}}};
  CHECK(in_short(read_answer(context, "the cube")) == "unclear");
  context.options = {{0, "yellow basket", {}}, {1, "spoon", {}}};
  CHECK(in_short(read_answer(context, "the red basket")) == "unclear");
  context.options = {{0, "thing", {"gizmo"}}, {1, "part", {"gizmo"}}};
  CHECK(in_short(read_answer(context, "gizmo")) == "unclear");
}

TEST_CASE("yes and no are read from the words that answer, and both are unclear") {
  check(QuestionForm::kYesNo,
        {
            {"Yes", "yes", "yes or no first"},
            {"yes.", "yes", "yes or no first"},
            {"YES!", "yes", "yes or no first"},
            {"**Yes**", "yes", "yes or no first"},
            {"No", "no", "yes or no first"},
            {"No.", "no", "yes or no first"},
            {"Yes, it is", "yes", "yes or no first"},
            {"Yes it is on the left", "yes", "yes or no first"},
            {"No, there is no carrot.", "no", "yes or no first"},
            {"No carrot is there.", "no", "yes or no first"},
            {"No, it is not.\nThe plate is.", "no", "yes or no first"},
            {"Nope", "no", "yes or no first"},
            {"True", "yes", "yes or no first"},
            {"False.", "no", "yes or no first"},
            {"Correct.", "yes", "yes or no first"},
            {"Correct objects are there", "unclear", "one word"},
            {"\uff39\uff45\uff53", "yes", "yes or no first"},
            {"I looked at it.\nYes", "yes", "yes or no first"},
            {"Yes and no", "unclear", "yes or no first"},
            {"Yes/No", "unclear", "yes or no first"},
            {"yes or no", "unclear", "yes or no first"},
            {"Yes. No.", "unclear", "yes or no first"},
            {"No... yes!", "unclear", "yes or no first"},
            {"There is no carrot on the table.", "no", "there is"},
            {"There is a carrot on the table.", "yes", "there is"},
            {"There isn't a carrot.", "no", "there is"},
            {"There are carrots in the picture", "yes", "there is"},
            {"There is a plate on the table.", "unclear", "there is"},
            {"There isn't no carrot.", "unclear", "there is"},
            {"It is.", "yes", "it is"},
            {"It is not.", "no", "it is"},
            {"It isn't", "no", "it is"},
            {"They are not.", "no", "it is"},
            {"It does", "yes", "it is"},
            {"I'd say yes", "yes", "one word"},
            {"It lies there, so yes.", "yes", "one word"},
            {"I would say: no", "no", "one word"},
            {"That is not true", "unclear", "one word"},
            {"maybe yes, maybe no", "unclear", "one word"},
            {"The carrot is to the right of the plate.", "unclear", "nothing that answers"},
            {"maybe", "unclear", "nothing that answers"},
            {"Answer: yes", "yes", "answer line: yes or no first"},
            {"The answer is no.", "no", "answer line: yes or no first"},
            {"<answer>no</answer>", "no", "tag: yes or no first"},
            {"{\"answer\": true}", "yes", "json: yes or no first"},
            {"{\"answer\": \"no\"}", "no", "json: yes or no first"},
            {"\\boxed{\\text{Yes}}", "yes", "box: yes or no first"},
            {"I cannot tell.", "refused", "refused"},
            {"I don't know", "refused", "refused"},
            {"<think>yes", "empty", "thoughts alone"},
        });
}

TEST_CASE("a number is read from digits and words, and two of them are unclear") {
  check(QuestionForm::kNumber, {
                                   {"3", "3", "number alone"},
                                   {"3.", "3", "number alone"},
                                   {"**3**", "3", "number alone"},
                                   {"(3)", "3", "number alone"},
                                   {"\uff13", "3", "number alone"},
                                   {"three", "3", "number alone"},
                                   {"Zero", "0", "number alone"},
                                   {"twenty", "20", "number alone"},
                                   {"2 (two)", "2", "number alone"},
                                   {"2. One carrot and one plate.", "2", "number alone"},
                                   {"One carrot and one plate make\n2", "2", "number alone"},
                                   {"3 4", "unclear", "number alone"},
                                   {"3,4", "unclear", "number alone"},
                                   {"1,000", "unclear", "number alone"},
                                   {"-3", "unclear", "number alone"},
                                   {"2.5", "unclear", "number alone"},
                                   {"1/2", "unclear", "number alone"},
                                   {"\u00bd", "unclear", "number alone"},
                                   {"10%", "unclear", "number alone"},
                                   {"99999999999999999999", "unclear", "number alone"},
                                   {"3\n4", "unclear", "number alone"},
                                   {"two carrots", "2", "one number"},
                                   {"There are 2 carrots.", "2", "one number"},
                                   {"There are two (2) carrots", "2", "one number"},
                                   {"3 or 4", "unclear", "one number"},
                                   {"one or two", "unclear", "one number"},
                                   {"1 plate, 2 carrots", "unclear", "one number"},
                                   {"not 3 carrots", "unclear", "one number"},
                                   {"twenty-one things", "unclear", "one number"},
                                   {"at least 3", "unclear", "hedged"},
                                   {"about three", "unclear", "hedged"},
                                   {"a dozen", "unclear", "hedged"},
                                   {"none", "0", "none"},
                                   {"There are no carrots.", "0", "none"},
                                   {"No", "unclear", "nothing that answers"},
                                   {"the 3rd", "unclear", "nothing that answers"},
                                   {"many", "unclear", "nothing that answers"},
                                   {"Answer: 3", "3", "answer line: number alone"},
                                   {"Answer: -3", "unclear", "answer line: number alone"},
                                   {"{\"count\": 3}", "3", "json: number alone"},
                                   {"<answer>3</answer>", "3", "tag: number alone"},
                                   {"\\boxed{3}", "3", "box: number alone"},
                                   {"I can't see it", "refused", "refused"},
                               });
}

TEST_CASE("a point is read in pixels, and what is another unit, a box or two points is unclear") {
  check(QuestionForm::kPoint,
        {
            {"(123, 45)", "123 45", "bracketed"},
            {"[123, 45]", "123 45", "bracketed"},
            {"(123.5, 45.25)", "123.5 45.25", "bracketed"},
            {"(123px, 45px)", "123 45", "bracketed"},
            {"( 123 ; 45 )", "123 45", "bracketed"},
            {"[[123, 45]]", "123 45", "bracketed"},
            {"The carrot is at (123, 45).", "123 45", "bracketed"},
            {"In the 640x480 picture it is at (123, 45).", "123 45", "bracketed"},
            {"(-5, 10)", "-5 10", "bracketed"},
            {"(700, 900)", "700 900", "bracketed"},
            {"{\"point_2d\": [123, 45], \"label\": \"carrot\"}", "123 45", "bracketed"},
            {"```json\n[{\"point_2d\": [123, 45], \"label\": \"carrot\"}]\n```", "123 45",
             "bracketed"},
            {"(1, 2) (1, 2)", "1 2", "bracketed"},
            {"(1, 2) and (3, 4)", "unclear", "bracketed"},
            {"[100, 20, 140, 60]", "unclear", "bracketed"},
            {"{\"bbox_2d\": [100, 20, 140, 60]}", "unclear", "bracketed"},
            {"(0.25, 0.5)", "unclear", "bracketed"},
            {"(0, 0)", "0 0", "bracketed"},
            {"x=123, y=45", "123 45", "labelled"},
            {"x: 123 y: 45", "123 45", "labelled"},
            {"X is 123 and Y is 45", "123 45", "labelled"},
            {"The x coordinate is 123, the y coordinate is 45.", "123 45", "labelled"},
            {"(x=123, y=45)", "123 45", "labelled"},
            {"{\"x\": 123, \"y\": 45}", "123 45", "labelled"},
            {"x=123", "unclear", "labelled"},
            {"x=1, y=2; x=3, y=4", "unclear", "labelled"},
            {"x=0.25, y=0.5", "unclear", "labelled"},
            {"123, 45", "123 45", "pair"},
            {"123 45", "123 45", "pair"},
            {"123,45", "123 45", "pair"},
            {"123 px, 45 px", "123 45", "pair"},
            {"12%, 45%", "unclear", "pair"},
            {"1, 2, 3", "unclear", "pair"},
            {"123", "unclear", "pair"},
            {"1e9999, 3", "unclear", "pair"},
            {"<loc0512><loc0256>", "160.3125 240.234375", "location tokens"},
            {"<loc0512><loc0256> carrot", "160.3125 240.234375", "location tokens"},
            {"<loc0100><loc0200><loc0300><loc0400> carrot", "unclear", "location tokens"},
            {"<point x=\"12.3\" y=\"45.6\" alt=\"carrot\">carrot</point>", "unclear", "point tag"},
            {"<point x=\"312.3\" y=\"45.6\">carrot</point>", "312.3 45.6", "point tag"},
            {"<points x1=\"312\" y1=\"45\" x2=\"320\" y2=\"50\">", "unclear", "point tag"},
            {"Answer: (123, 45)", "123 45", "answer line: bracketed"},
            {"<answer>123, 45</answer>", "123 45", "tag: pair"},
            {"\\boxed{(123, 45)}", "123 45", "box: bracketed"},
            {"on the left", "unclear", "nothing that answers"},
            {"I'm unable to point.", "refused", "refused"},
            {"", "empty", "blank"},
        });
}

TEST_CASE("a sentence is read as the objects that it names, each once and in order") {
  check(QuestionForm::kFree,
        {
            {"Put the carrot on the plate.", "7 5", "sentence"},
            {"The plate should hold the carrot, the plate!", "5 7", "sentence"},
            {"put the rabbit's favorite vegetable into the basket", "7 0", "sentence"},
            {"do something", "", "sentence"},
            {"A answer: B", "", "sentence"},
            {"{\"answer\": \"the carrot\"}", "7", "json: sentence"},
            {"I'm sorry, I can't see the picture.", "refused", "refused"},
            {"I can't see more than the carrot.", "7", "sentence"},
            {"<think>carrot", "empty", "thoughts alone"},
        });
}

TEST_CASE("every place where an answer is looked for has a name and is explained") {
  std::set<std::string_view> names;
  for (const RuleInfo& place : places()) {
    CHECK(names.insert(place.name).second);
    CHECK_FALSE(place.says.empty());
  }
  CHECK(names == std::set<std::string_view>{"tag", "box", "json", "answer line"});
}

TEST_CASE("answers of 10 MB are read in linear time, as unclear or by what is left of them") {
  const std::size_t size = 10u << 20;
  const auto repeated = [&](const std::string& part) {
    std::string text;
    while (text.size() < size) text += part;
    return text;
  };
  const auto begin = std::chrono::steady_clock::now();
  for (const QuestionForm form :
       {QuestionForm::kChoice, QuestionForm::kYesNo, QuestionForm::kNumber, QuestionForm::kPoint,
        QuestionForm::kFree}) {
    const ReadContext context = context_of(form);
    for (const char* part : {"B ", "<", "carrot ", "<think>", "</think>", "{[", "a\u0301\u0323"}) {
      const Reading reading = read_answer(context, repeated(part));
      CHECK((reading.verdict == Verdict::kUnclear || reading.verdict == Verdict::kEmpty));
    }
  }
  const ReadContext context = context_of(QuestionForm::kChoice);
  CHECK(in_short(read_answer(context, "<think>" + repeated("A? ") + "</think>B")) == "option 5");
  CHECK(in_short(read_answer(context, repeated("\n") + "B")) == "option 5");
  CHECK(std::chrono::steady_clock::now() - begin < std::chrono::seconds(60));
}

TEST_CASE("the longest answers that are read take no longer than their length allows") {
  const auto filled = [](const std::string& part) {
    std::string text;
    while (text.size() + part.size() <= kLongestAnswer) text += part;
    return text;
  };
  const auto begin = std::chrono::steady_clock::now();
  for (const QuestionForm form :
       {QuestionForm::kChoice, QuestionForm::kYesNo, QuestionForm::kNumber, QuestionForm::kPoint,
        QuestionForm::kFree}) {
    const ReadContext context = context_of(form);
    for (const char* part : {"B carrot ",   "B",
                             "carrot ",     "carrot. ",
                             "A. carrot\n", "answer: ",
                             "answer: B\n", "\\boxed{",
                             "[",           "{\"answer\":",
                             "1 ",          "(1,2) ",
                             "x=1 ",        "yes ",
                             "no. ",        "there is a carrot. ",
                             "<loc0001>",   "<point ",
                             "not ",        "orange ",
                             "<answer>",    "\n",
                             ". ",          "( B ) "}) {
      CHECK_FALSE(read_answer(context, filled(part)).rule.empty());
    }
  }
  CHECK(std::chrono::steady_clock::now() - begin < std::chrono::seconds(60));
}

}  // namespace probe::ask
