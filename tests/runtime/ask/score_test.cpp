#include "runtime/ask/score.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "runtime/ask/plan_reading.h"
#include "runtime/base/sha256.h"
#include "runtime/plan/ids.h"
#include "runtime/plan/questions.h"
#include "runtime/stats/intervals.h"
#include "tests/runtime/plan/small_plan.h"

namespace probe::ask {
namespace {

using plan::QuestionForm;
using plan::QuestionTruth;

struct Asks {
  std::string set, family;
  QuestionForm form;
  QuestionTruth truth;
  std::uint32_t task;
  std::string text;
  std::vector<std::vector<std::string>> options;  // the name, then other words
  std::uint32_t right = plan::kNone;
  std::uint32_t a = plan::kNone, b = plan::kNone;
};

// Families in the order of their first question; tasks 0 (carrot_on_plate) and 1 begin alike, in
// two starts each.
plan::Plan plan_with(const std::vector<Asks>& all) {
  plan::Writer w = plan::small_writer();
  std::vector<std::string> families;
  for (const Asks& asks : all) {
    const std::string name = asks.set + "." + asks.family;
    if (std::find(families.begin(), families.end(), name) == families.end()) {
      plan::FamilyRecord family;
      family.set = w.text(asks.set);
      family.name = w.text(asks.family);
      family.text = w.text(asks.text);
      family.form = static_cast<std::uint32_t>(asks.form);
      family.moment = static_cast<std::uint32_t>(plan::QuestionMoment::kStart);
      family.pixels = 64;
      w.records.families.push_back(family);
      families.push_back(name);
    }
  }
  for (const Asks& asks : all) {
    plan::QuestionRecord question;
    const std::string name = asks.set + "." + asks.family;
    question.family = static_cast<std::uint32_t>(std::find(families.begin(), families.end(), name) -
                                                 families.begin());
    question.task = asks.task;
    question.text = w.text(asks.text);
    question.truth = static_cast<std::uint32_t>(asks.truth);
    question.right = asks.right;
    question.a = asks.a;
    question.b = asks.b;
    std::vector<plan::OptionRecord> options;
    for (std::size_t i = 0; i < asks.options.size(); ++i) {
      plan::OptionRecord option;
      option.text = w.text(asks.options[i][0]);
      option.body = i < 2 ? static_cast<std::uint32_t>(i) : plan::kNone;
      std::vector<plan::StringRef> words;
      for (std::size_t n = 1; n < asks.options[i].size(); ++n)
        words.push_back(w.text(asks.options[i][n]));
      option.words = plan::append<plan::StringRef>(w.records.words, words);
      options.push_back(option);
    }
    question.options = plan::append<plan::OptionRecord>(w.records.options, options);
    w.records.questions.push_back(question);
  }
  auto bytes = w.finish();
  REQUIRE_MESSAGE(bytes.ok(), to_text(bytes.failure()));
  auto made = plan::Plan::from_bytes(std::move(*bytes));
  REQUIRE_MESSAGE(made.ok(), to_text(made.failure()));
  return std::move(*made);
}

const std::vector<std::vector<std::string>> kThree = {
    {"carrot", "orange object"}, {"plate"}, {"towel"}};
const std::vector<std::vector<std::string>> kOne = {{"carrot", "orange object"}};

Asks source_of(std::uint32_t task, const std::string& text = "Which one?") {
  return {"all", "source", QuestionForm::kChoice, QuestionTruth::kProved, task, text, kThree, 0};
}

// A valid row of a choice: the option that was given, or what the text was read as.
AnswerRow row_of(const plan::Plan& plan, std::uint32_t question, std::uint32_t index,
                 std::uint32_t rotation, bool right) {
  const plan::QuestionRecord& record = plan.questions()[question];
  const plan::TaskRecord& task = plan.tasks()[record.task];
  AnswerRow row;
  row.question_id = to_hex(plan::to_sha256(record.question_id));
  row.start_id = to_hex(plan::to_sha256(plan.episodes()[task.episodes.first + index].start_id));
  row.rotation = rotation;
  row.episode = static_cast<int>(index);
  row.task = plan.text(task.name);
  row.reading.verdict = Verdict::kRead;
  row.right = right;
  if (plan::form_of(plan.families()[record.family]) == QuestionForm::kChoice)
    row.reading.option = right ? record.right : (record.right + 1) % record.options.count;
  return row;
}

std::vector<Asked> asked_of(const plan::Plan& plan, const std::vector<AnswerRow>& rows) {
  Tally tally(plan);
  for (const AnswerRow& row : rows) {
    const Status added = tally.add(row);
    REQUIRE_MESSAGE(added.ok(), to_text(added.failure()));
  }
  return tally.asked();
}

}  // namespace

TEST_CASE("a start counts as right only if all rotations are, and plainly by one rotation") {
  const plan::Plan plan = plan_with({source_of(0)});
  std::vector<AnswerRow> rows;
  for (std::uint32_t rotation = 0; rotation < 3; ++rotation) {
    rows.push_back(row_of(plan, 0, 0, rotation, true));
    rows.push_back(row_of(plan, 0, 1, rotation, rotation != 2));
  }
  const auto asked = asked_of(plan, rows);
  REQUIRE(asked.size() == 2);
  CHECK(asked[0].circular == true);
  CHECK(asked[0].plain == true);
  CHECK(asked[1].circular == false);
  CHECK(asked[1].plain == true);  // rotation 1 is episode 1's
  // Rotation 0 shows option 0 at A; rotation 1 shows it at C.
  CHECK(asked[0].right_letter == 0);
  CHECK(asked[1].right_letter == 2);
  CHECK(asked[1].given_letter == 2);

  const auto scores = score(plan, asked);
  REQUIRE(scores.size() == 1);
  REQUIRE(scores[0].of(Arm::kPicture));
  CHECK_FALSE(scores[0].of(Arm::kBlind));
  const ArmScore& arm = *scores[0].of(Arm::kPicture);
  CHECK(arm.rows == 6);
  CHECK(arm.circular.count.k == 1);
  CHECK(arm.circular.count.n == 2);
  CHECK(arm.plain.count.k == 2);
  CHECK(arm.incomplete == 0);
  CHECK(arm.right_letters == std::vector<std::int64_t>{1, 0, 1});
  CHECK(arm.given_letters == std::vector<std::int64_t>{1, 0, 1});
  // One task, one row a start: Wilson's own.
  const stats::Interval wilson = stats::wilson({1, 2});
  CHECK(arm.circular.interval.low == doctest::Approx(wilson.low));
  CHECK(arm.circular.interval.high == doctest::Approx(wilson.high));
  CHECK_FALSE(arm.likely_circular);
  CHECK_FALSE(arm.copied);

  const Floors& floors = scores[0].floors;
  CHECK(*floors.random_plain == doctest::Approx(1.0 / 3));
  CHECK(*floors.random_circular == doctest::Approx(1.0 / 27));
  CHECK(*floors.first_plain == doctest::Approx(0.5));
  CHECK(*floors.first_circular == 0);
}

TEST_CASE("what is invalid or missing counts neither way, what was not read counts as not right") {
  const plan::Plan plan = plan_with({source_of(0)});
  std::vector<AnswerRow> rows;
  for (std::uint32_t rotation = 0; rotation < 3; ++rotation)
    rows.push_back(row_of(plan, 0, 0, rotation, true));
  rows[1].right.reset();
  rows[1].invalid = "model: HTTP 500";
  rows.push_back(row_of(plan, 0, 1, 1, false));
  rows.back().reading = {.verdict = Verdict::kUnclear};
  rows.push_back(row_of(plan, 0, 1, 0, false));
  rows.back().reading = {.verdict = Verdict::kRefused};
  const auto before = asked_of(plan, rows);
  CHECK_FALSE(before[0].circular);
  CHECK(before[0].plain == true);
  CHECK_FALSE(before[1].circular);
  CHECK(before[1].plain == false);
  rows.push_back(row_of(plan, 0, 1, 2, false));
  rows.back().reading = {.verdict = Verdict::kEmpty};
  const auto asked = asked_of(plan, rows);
  CHECK(asked[1].circular == false);
  const auto scores = score(plan, asked);
  const ArmScore& arm = *scores[0].of(Arm::kPicture);
  CHECK(arm.rows == 6);
  CHECK(arm.invalid == 1);
  CHECK(arm.unclear == 1);
  CHECK(arm.refused == 1);
  CHECK(arm.empty == 1);
  CHECK(arm.incomplete == 1);
  CHECK(arm.circular.count.n == 1);
  CHECK(arm.circular.count.k == 0);
  CHECK(arm.plain.count.n == 2);
  CHECK(arm.plain.count.k == 1);
}

TEST_CASE("arms, recorded episodes and families are counted apart") {
  const plan::Plan plan = plan_with(
      {source_of(0),
       {"all", "there", QuestionForm::kYesNo, QuestionTruth::kProved, 0, "Is it there?", kOne, 1},
       {"all", "left", QuestionForm::kYesNo, QuestionTruth::kLeftOf, 0, "Left?", kThree,
        plan::kNone, 0, 1}});
  std::vector<AnswerRow> rows;
  for (const Arm arm : {Arm::kPicture, Arm::kBlind, Arm::kPrior}) {
    for (std::uint32_t question = 1; question < 3; ++question) {
      for (std::uint32_t index = 0; index < 2; ++index) {
        rows.push_back(row_of(plan, question, index, 0, arm == Arm::kPicture || index == 0));
        rows.back().arm = arm;
        // What is right is told by the row, whatever was read.
        rows.back().expected = question == 1 || index == 0 ? "yes" : "no";
        if (!*rows.back().right) rows.back().reading = {.verdict = Verdict::kUnclear};
      }
    }
  }
  const auto scores = score(plan, asked_of(plan, rows));
  REQUIRE(scores.size() == 2);
  for (const ScoreRow& row : scores) {
    CHECK(row.of(Arm::kPicture)->circular.count.k == 2);
    CHECK(row.of(Arm::kBlind)->circular.count.k == 1);
    CHECK(row.of(Arm::kPrior)->plain.count.k == 1);
    CHECK(row.of(Arm::kPicture)->right_letters.empty());
    CHECK(*row.floors.random_circular == 0.5);
    CHECK(row.of(Arm::kBlind)->unclear == 1);
  }
  CHECK(*scores[0].floors.first_plain == 1);    // proved: always yes
  CHECK(*scores[1].floors.first_plain == 0.5);  // told by the rows: yes and no

  rows = {row_of(plan, 1, 0, 0, true), row_of(plan, 1, 0, 0, false)};
  rows[1].seed = 42;
  CHECK(asked_of(plan, rows).size() == 2);
}

TEST_CASE("tasks that share question, start and answer share a row, in every set of theirs") {
  const plan::Plan plan = plan_with({source_of(0), source_of(1)});
  CHECK(plan.questions()[0].question_id == plan.questions()[1].question_id);
  REQUIRE(plan.episodes()[0].start_id == plan.episodes()[2].start_id);
  std::vector<AnswerRow> rows;
  for (std::uint32_t rotation = 0; rotation < 3; ++rotation)
    rows.push_back(row_of(plan, 1, 0, rotation, true));
  const auto asked = asked_of(plan, rows);
  REQUIRE(asked.size() == 1);
  CHECK(asked[0].question == 0);

  const auto known = knows(plan, asked, "source");
  REQUIRE(known.ok());
  REQUIRE(known->size() == 2);
  CHECK((*known)[0].task == 0);
  CHECK((*known)[0].episode == 0);
  CHECK((*known)[1].task == 1);
  CHECK((*known)[1].episode == 2);
  CHECK((*known)[1].knows == true);
  CHECK(knows(plan, asked, "all.source")->size() == 2);
  CHECK(knows(plan, asked, "source", Arm::kBlind)->empty());
  CHECK(knows(plan, asked, "sauce").failure().message == "no questions are called `sauce`");

  const auto by_set = score(plan, asked, true);
  REQUIRE(by_set.size() == 1);
  CHECK(plan.text(plan.sets()[by_set[0].set].name) == "core");
  CHECK(by_set[0].of(Arm::kPicture)->circular.count.n == 1);
}

TEST_CASE("a family's name that two sets have does not say which is known") {
  Asks other = source_of(0);
  other.set = "more";
  const plan::Plan plan = plan_with({source_of(0), other});
  CHECK(knows(plan, {}, "source").failure().message ==
        "several sets have questions called `source`: say which, as SET.source");
  CHECK(knows(plan, {}, "more.source").ok());
}

TEST_CASE("starts of tasks in one place are one cluster, which is worth less than two") {
  const plan::Plan plan = plan_with({source_of(0, "First?"), source_of(1, "Second?")});
  std::vector<AnswerRow> rows;
  for (const std::uint32_t question : {0U, 1U}) {
    for (const std::uint32_t index : {0U, 1U}) {
      for (std::uint32_t rotation = 0; rotation < 3; ++rotation)
        rows.push_back(row_of(plan, question, index, rotation, index == 0));
    }
  }
  const auto scores = score(plan, asked_of(plan, rows));
  const Rate& rate = scores[0].of(Arm::kPicture)->circular;
  CHECK(rate.count.k == 2);
  CHECK(rate.count.n == 4);
  const stats::Interval apart = stats::wilson({2, 4});
  CHECK(rate.interval.high - rate.interval.low > apart.high - apart.low);
}

TEST_CASE("the likeliest letter is scored where the server tells, and a tie is not right") {
  const plan::Plan plan = plan_with({source_of(0)});
  std::vector<AnswerRow> rows;
  for (std::uint32_t rotation = 0; rotation < 3; ++rotation) {
    for (const std::uint32_t index : {0U, 1U}) {
      rows.push_back(row_of(plan, 0, index, rotation, false));
      // The right option, 0, stands at place (3 - rotation) % 3.
      std::vector<std::optional<double>> letters(3, -3.0);
      letters[(3 - rotation) % 3] = -0.1;
      if (index == 1 && rotation == 2) letters = {-1.0, -1.0, std::nullopt};
      rows.back().usage.letter_logprobs = letters;
    }
  }
  auto asked = asked_of(plan, rows);
  CHECK(asked[0].circular == false);
  CHECK(asked[0].likely_circular == true);
  CHECK(asked[1].likely_circular == false);
  CHECK(asked[1].likely_plain == true);
  const auto scores = score(plan, asked);
  CHECK(scores[0].of(Arm::kPicture)->likely_circular->count.k == 1);
  CHECK(scores[0].of(Arm::kPicture)->likely_plain->count.k == 2);
  CHECK(scores[0].of(Arm::kPicture)->circular.count.k == 0);

  rows[0].usage.letter_logprobs = {std::nullopt, std::nullopt, std::nullopt};
  CHECK_FALSE(asked_of(plan, rows)[0].likely_circular);
  rows[0].usage.letter_logprobs.clear();
  asked = asked_of(plan, rows);
  CHECK_FALSE(asked[0].likely_circular);
}

TEST_CASE("copies of the instruction that are not right are counted, with the mean of the shares") {
  const plan::Plan plan =
      plan_with({{"all", "restate", QuestionForm::kFree, QuestionTruth::kMentions, 0, "Say it.",
                  kThree, plan::kNone, 0, 1}});
  std::vector<AnswerRow> rows;
  for (const std::uint32_t index : {0U, 1U}) {
    rows.push_back(row_of(plan, 0, index, 0, index == 1));
    rows.back().copied = index == 0 ? 1.0 : 0.5;
  }
  const auto scores = score(plan, asked_of(plan, rows));
  const ArmScore& arm = *scores[0].of(Arm::kPicture);
  CHECK(*arm.copied == doctest::Approx(0.75));
  CHECK(arm.copies == 1);
  CHECK(arm.plain.count.k == 1);
  CHECK_FALSE(scores[0].floors.random_plain);
  CHECK_FALSE(scores[0].floors.first_plain);
}

TEST_CASE("rows of other plans, doubled rows and rotations that there are not are refused") {
  const plan::Plan plan = plan_with({source_of(0)});
  Tally tally(plan);
  AnswerRow row = row_of(plan, 0, 0, 0, true);
  REQUIRE(tally.add(row).ok());
  CHECK_FALSE(tally.add(row).ok());
  row.rotation = 3;
  CHECK_FALSE(tally.add(row).ok());
  row = row_of(plan, 0, 0, 1, true);
  row.start_id = std::string(64, '0');
  CHECK(tally.add(row).failure().code == Fault::kStore);
  row = row_of(plan, 0, 0, 1, true);
  row.question_id = std::string(64, '0');
  CHECK(tally.add(row).failure().message.starts_with("the plan has no question 0000"));
  row = row_of(plan, 0, 0, 1, true);
  row.episode = -1;
  CHECK_FALSE(tally.add(row).ok());
  CHECK(tally.asked().size() == 1);
}

TEST_CASE("a plan's question is read with its options in the order in which they were shown") {
  const plan::Plan plan =
      plan_with({source_of(0),
                 {"all", "restate", QuestionForm::kFree, QuestionTruth::kMentions, 1, "Say it.",
                  kThree, plan::kNone, 0, 1}});
  const std::vector<std::uint32_t> shown = {2, 0, 1};
  const ReadContext context = read_context(plan, plan.questions()[0], shown, 640, 480);
  CHECK(context.form == QuestionForm::kChoice);
  CHECK(context.question == "Which one?");
  CHECK(read_answer(context, "A").option == 2);
  CHECK(read_answer(context, "B) the orange object").option == 0);

  // The instruction is "drop carrot on plate".
  const Restatement restated =
      restate(plan, plan.questions()[1], "Drop the orange object on the plate", "stop");
  CHECK(restated.right);
  CHECK(restated.copied == 1);
  CHECK(restated.reading.mentioned == std::vector<std::uint32_t>{0, 1});
}

}  // namespace probe::ask
