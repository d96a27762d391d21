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
  const std::string plain = likeness_without_courtesy("put carrot on plate");
  for (const char* same :
       {"Please put the carrot on the plate.", "could you put the carrot on the plate?",
        "Could you please put the carrot on the plate",
        "I'd like you to put the carrot on the plate", "put the carrot on the plate, please",
        "on the plate, put the carrot, thank you!"})
    CHECK_MESSAGE(likeness_without_courtesy(same) == plain, same);
  for (const char* other :
       {"I want the carrot on the plate", "could put carrot on plate", "put you carrot on plate"})
    CHECK_MESSAGE(likeness_without_courtesy(other) != plain, other);
  CHECK(likeness_without_courtesy("please") == "please");
  CHECK(likeness("please put carrot on plate") != likeness("put carrot on plate"));
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
  const auto find = [&](const std::string& text) { return evaluations.find(text, likeness(text)); };
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
}
