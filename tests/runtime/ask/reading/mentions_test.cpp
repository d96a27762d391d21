#include "runtime/ask/reading/mentions.h"

#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "tests/runtime/ask/reading/reading.h"

namespace probe::ask {
namespace {

// Options of the tests: carrot (7), plate (5), towel (3), spoon (1).
std::vector<ShownOption> table_options() {
  return {{7, "carrot", {"carrot", "orange object", "rabbit's favorite vegetable"}},
          {5, "plate", {"plate", "round shaped object"}},
          {3, "towel", {"blue object"}},
          {1, "spoon", {"kitchenware for eating soup"}}};
}

constexpr std::string_view kPlain = "put carrot on plate";
constexpr std::string_view kRabbit = "put rabbit's favorite vegetable on the plate";
constexpr std::string_view kNot = "put the carrot on the plate, not the towel";

Restatement said(std::string_view instruction, std::string_view answer) {
  static const auto options = table_options();
  return restate({options, 7, 5, instruction}, answer);
}

}  // namespace

TEST_CASE("a restatement is right when source and target stand in their roles by plain names") {
  for (const char* right : {
           "Put the carrot on the plate.",
           "The robot has to pick up the carrot and place it on the plate.",
           "The robot has to put the carrot onto the round yellow plate",
           "Move carrot to the plate",
           "The carrot is placed on the plate.",
           "The carrot should be placed on top of the plate.",
           "The plate should hold the carrot.",
           "The plate has the carrot on it in the end.",
           "On the plate, the robot must put the carrot.",
           "To pick up the carrot and drop it into the plate",
           "Put the carrot on the plate. The plate is yellow.",
           "Carrot on plate",
           "PLACE THE CARROTS ON THE PLATE!",
           "Put the carrot, not the spoon, on the plate",
           "Put the carrot on the plate and not on the towel",
           "Put the carrot on the plate instead of the towel",
           "Put the carrot on the plate, leaving the towel alone",
           "Put the carrot on the plate, ignoring the towel and the spoon",
           "Put the carrot (not the spoon or the towel) on the plate",
           "Put the carrot \u2014 not the spoon \u2014 on the plate",
           "Put the carrot not on the towel but on the plate",
           "Put the carrot on the plate; do not put the carrot on the towel",
           "Put the carrot on the plate, the towel is not used",
           "<answer>Put the carrot on the plate.</answer>",
           "{\"answer\": \"Put the carrot on the plate.\"}",
           "<think>The towel?</think>Put the carrot on the plate.",
       }) {
    CAPTURE(right);
    for (const std::string_view instruction : {kPlain, kRabbit, kNot}) {
      const Restatement restated = said(instruction, right);
      CHECK(restated.wrong_by == "");
      CHECK(restated.right);
    }
  }
}

TEST_CASE(
    "a restatement is wrong by what it lacks, by roles that are exchanged, by other objects") {
  const std::vector<std::pair<std::string, std::string>> table = {
      {"Put the plate on the carrot.", "it takes the goal for what is moved"},
      {"The plate is put on the carrot.", "it takes what is moved for the goal"},
      {"The carrot should hold the plate.", "it takes what is moved for the goal"},
      {"Put the carrot on the table.", "it does not mention the goal"},
      {"Pick up the carrot.", "it does not mention the goal"},
      {"Put it on the plate.", "it does not mention what is moved"},
      {"Put something somewhere.", "it does not mention what is moved"},
      {"Plate, carrot.", "it does not mention the goal"},
      {"Put the spoon on the plate.", "it mentions another object"},
      {"Put the carrot on the towel.", "it mentions another object"},
      {"Put the carrot and the spoon on the plate.", "it mentions another object"},
      {"Move the carrot from the towel to the plate.", "it mentions another object"},
      {"Put the carrot on the plate near the spoon.", "it mentions another object"},
      {"Put the spoon, not the carrot, on the plate.", "it mentions another object"},
      {"Do not put the carrot on the plate.", "it avoids what is meant"},
      {"Put the carrot anywhere but not on the plate.", "it avoids what is meant"},
  };
  for (const auto& row : table) {
    CAPTURE(row.first);
    for (const std::string_view instruction : {kPlain, kRabbit, kNot}) {
      const Restatement restated = said(instruction, row.first);
      CHECK_FALSE(restated.right);
      CHECK(restated.wrong_by == row.second);
    }
  }
}

TEST_CASE("beside or under the goal, a second place, where it lies and a refusal are not right") {
  for (const char* wrong : {
           "Put the carrot under the plate.",
           "Put the carrot beside the plate.",
           "Put the carrot near the plate.",
           "Put the carrot below the plate.",
           "Hold the carrot above the plate.",
           "Move the carrot towards the plate.",
           "Put the carrot next to the plate.",
           "Put the carrot on the left of the plate.",
           "Put the carrot on the plate, then onto the floor.",
           "Put the carrot on the plate and onto the floor.",
           "Remove the carrot which is on the plate.",
           "Take the carrot that lies on the plate.",
           "The carrot is on the plate.",
           "Stop the robot from putting the carrot on the plate.",
           "Refuse to put the carrot on the plate.",
       }) {
    CAPTURE(wrong);
    CHECK_FALSE(said(kPlain, wrong).right);
  }
  CHECK(said(kPlain, "Pick up the carrot, then put it on the plate.").right);
  CHECK(said(kPlain, "The carrot is on the left. Put it on the plate.").right);
}

TEST_CASE(
    "who repeats the instruction's phrase has not named the object, who repeats its name has") {
  const Restatement copy = said(kRabbit, kRabbit);
  CHECK_FALSE(copy.right);
  CHECK(copy.wrong_by == "it does not name what is moved, only describes it");
  CHECK(copy.copied == 1);
  CHECK(copy.mentions == std::vector<Mention>{{7, MentionRole::kMoved, MentionWords::kInstruction},
                                              {5, MentionRole::kGoal, MentionWords::kPlain}});

  const Restatement named = said(kRabbit, "Put the carrot on the plate.");
  CHECK(named.right);
  CHECK(named.copied == doctest::Approx(0.25));

  // Another phrase denotes it, too, but was not what was asked for.
  const Restatement described = said(kRabbit, "Put the orange object on the plate.");
  CHECK_FALSE(described.right);
  CHECK(described.mentions[0].words == MentionWords::kOther);
  CHECK(said(kPlain, "Put the orange object on the plate.").right);

  const Restatement plain = said(kPlain, kPlain);
  CHECK(plain.right);
  CHECK(plain.copied == 1);
  CHECK(said(kPlain, "Move the carrot onto the plate").copied == 0);
}

TEST_CASE("the noun of a plain name that the plan has among the words names the object") {
  const std::vector<ShownOption> options = {
      {0, "eggplant", {"purple object"}},
      {1, "yellow basket", {"basket", "where the dishes usually get dried"}}};
  const RestateContext context{options, 0, 1,
                               "put eggplant into where the dishes usually get dried"};
  CHECK(restate(context, "Put the eggplant into the basket.").right);
  CHECK(restate(context, "Put the eggplant into the yellow basket.").right);
  CHECK_FALSE(restate(context, "Put the eggplant into the red basket.").right);
  CHECK_FALSE(restate(context, "Put the eggplant where the dishes usually get dried.").right);
}

TEST_CASE("what is copied are words of its own, whatever their order, number and case") {
  CHECK(said(kRabbit, "ON THE PLATE: VEGETABLES, FAVORITE OF RABBIT\u2019S, PUT").copied == 1);
  CHECK(said(kRabbit, "a rabbit's vegetable").copied == doctest::Approx(0.5));
  CHECK(said("carrot plate", "the carrot").copied == doctest::Approx(0.5));
  CHECK(said("", "the carrot").copied == 0);
  CHECK(said(kNot, kNot).copied == 1);
  CHECK(said(kNot, "put carrot on plate").copied == doctest::Approx(0.5));
}

TEST_CASE("a task without a goal asks for none, and its plate is only to be avoided") {
  const auto options = table_options();
  const std::string_view instruction =
      "pick up the carrot and drop it elsewhere on the table, not on the plate.";
  const RestateContext context{options, 7, {}, instruction};
  CHECK(restate(context, instruction).right);
  CHECK(restate(context, "Put the carrot on the table, not on the plate").right);
  CHECK(restate(context, "Put the carrot anywhere but not on the plate").right);
  CHECK_FALSE(restate(context, "Put the carrot on the plate").right);
  CHECK(restate(context, instruction).copied == 1);
}

TEST_CASE("what is refused or empty is no restatement, and has nothing copied") {
  CHECK(said(kPlain, "").reading.verdict == Verdict::kEmpty);
  CHECK(said(kPlain, "I'm sorry, I cannot help with that.").reading.verdict == Verdict::kRefused);
  CHECK(said(kPlain, "I'm sorry, I cannot put it.").copied == 0);
  CHECK_FALSE(said(kPlain, "<think>put the carrot on the plate").right);
}

}  // namespace probe::ask
