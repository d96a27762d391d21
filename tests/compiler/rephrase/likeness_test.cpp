#include "compiler/rephrase/likeness.h"

#include <doctest/doctest.h>

#include "compiler/rephrase/leaks.h"

using namespace probe::rephrase;

TEST_CASE("wordings are alike up to case, articles, punctuation and the order of words") {
  const std::string plain = likeness("put carrot on plate");
  for (const char* same : {"Put the carrot on the plate.", "on a plate, put the carrot!",
                           "  PUT  carrot\ton  plate ", "put (carrot) on \"plate\""})
    CHECK_MESSAGE(likeness(same) == plain, same);
  for (const char* other : {"put carrot into plate", "put carrots on plate", "carrot on plate",
                            "put carrot on plate plate"})
    CHECK_MESSAGE(likeness(other) != plain, other);
}

TEST_CASE("who asks politely asks for the same, and what is only polite stays what it is") {
  const std::string plain = likeness("put carrot on plate");
  for (const char* same :
       {"Please put the carrot on the plate.", "could you put the carrot on the plate?",
        "Could you please put the carrot on the plate",
        "I'd like you to put the carrot on the plate", "put the carrot on the plate, please",
        "on the plate, put the carrot, thank you!"})
    CHECK_MESSAGE(likeness(same) == plain, same);
  for (const char* other :
       {"I want the carrot on the plate", "could put carrot on plate", "put you carrot on plate"})
    CHECK_MESSAGE(likeness(other) != plain, other);
  CHECK(likeness("please") == "please");
}

TEST_CASE("words of place that say the same are one, and others stay apart") {
  const std::string on = likeness("put carrot on plate"), in = likeness("put carrot in pot");
  for (const char* same : {"put carrot onto plate", "put the carrot on top of the plate",
                           "put carrot on the top of plate", "put carrot upon plate"})
    CHECK_MESSAGE(likeness(same) == on, same);
  for (const char* same :
       {"put carrot into pot", "put carrot inside the pot", "put carrot within pot"})
    CHECK_MESSAGE(likeness(same) == in, same);
  CHECK(likeness("put carrot in plate") != on);
  CHECK(likeness("put carrot next to plate") != on);
  CHECK(likeness("put the top carrot on plate") != on);
}

TEST_CASE("apostrophes leave no gap, and words of other scripts keep their letters") {
  CHECK(likeness("rabbit's favorite") == likeness("rabbit\u2019s favorite"));
  CHECK(likeness("rabbit's") == likeness("Rabbits"));
  CHECK(likeness("lege die \u00c4pfel") == likeness("\u00e4pfel die lege"));
  CHECK(likeness("?!") == "");
}

TEST_CASE("an instruction of a suite is found exactly before one that is only alike") {
  const Evaluations evaluations({{"a.probe", {{"put carrot on plate", "first"}}},
                                 {"b.probe", {{"put the carrot on the plate", "second"}}}});
  const auto find = [&](const std::string& text) { return evaluations.find(text); };
  const auto exact = find("put the carrot on the plate");
  REQUIRE(exact.has_value());
  CHECK(exact->is_exact);
  CHECK(exact->task == "second");
  CHECK(exact->suite == "b.probe");
  const auto alike = find("on the plate, put the carrot");
  REQUIRE(alike.has_value());
  CHECK_FALSE(alike->is_exact);
  CHECK(alike->task == "first");
  CHECK(alike->instruction == "put carrot on plate");
  CHECK_FALSE(find("put the carrot on the towel").has_value());
  // By the measure of splits: who was trained on one form has seen the other.
  for (const char* same : {"please put the carrot on the plate", "could you put carrot onto plate?",
                           "put the carrot on top of the plate", "Put carrot atop the plate"})
    CHECK_MESSAGE(find(same).has_value(), same);
  CHECK_FALSE(find("put the carrot into the plate").has_value());
}
