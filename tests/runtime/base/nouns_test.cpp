#include "runtime/base/nouns.h"

#include <doctest/doctest.h>

#include <utility>

using namespace probe;

TEST_CASE("a noun has one plural that is written and all those that are read") {
  const std::pair<const char*, const char*> written[] = {
      {"carrot", "carrots"},  {"box", "boxes"},     {"dish", "dishes"},
      {"glass", "glasses"},   {"berry", "berries"}, {"key", "keys"},
      {"tray", "trays"},      {"knife", "knives"},  {"loaf", "loaves"},
      {"potato", "potatoes"}, {"mango", "mangos"},  {"chef", "chefs"},
      {"shelf", "shelves"},   {"y", "ies"},         {"", "s"}};
  for (const auto& [one, many] : written) {
    CAPTURE(one);
    CHECK(plural_of(one) == many);
    if (one[0] == '\0' || one[1] == '\0') continue;
    CHECK(is_same_noun(one, many));
    CHECK(is_same_noun(many, one));
    CHECK(is_same_noun(one, one));
  }
  const std::pair<const char*, const char*> read[] = {{"mango", "mangoes"}, {"tomato", "tomatos"},
                                                      {"scarf", "scarfs"},  {"scarf", "scarves"},
                                                      {"knife", "knifes"},  {"leaf", "leafs"}};
  for (const auto& [one, many] : read) {
    CAPTURE(many);
    CHECK(is_same_noun(one, many));
    CHECK(is_same_noun(many, one));
  }
}

TEST_CASE("what only looks like a plural is another noun") {
  const std::pair<const char*, const char*> others[] = {
      {"glass", "glas"}, {"bus", "buss"},     {"box", "boxs"},       {"key", "keies"},
      {"can", "cane"},   {"berry", "berrys"}, {"pan", "pens"},       {"knife", "kniv"},
      {"", "carrot"},    {"plate", "plated"}, {"spoon", "spoonfuls"}};
  for (const auto& [a, b] : others) {
    CAPTURE(a);
    CHECK_FALSE(is_same_noun(a, b));
    CHECK_FALSE(is_same_noun(b, a));
  }
}

TEST_CASE("the article before words is as they are spoken") {
  const std::pair<const char*, const char*> said[] = {{"carrot", "a carrot"},
                                                      {"eggplant", "an eggplant"},
                                                      {"Orange can", "an Orange can"},
                                                      {"hourglass", "an hourglass"},
                                                      {"USB stick", "a USB stick"},
                                                      {"unicorn", "a unicorn"},
                                                      {"umbrella", "an umbrella"},
                                                      {"one", "a one"},
                                                      {"", "a "}};
  for (const auto& [words, with] : said) CHECK(with_indefinite_article(words) == with);
  CHECK((is_article("a") && is_article("an") && is_article("the")));
  CHECK_FALSE((is_article("") || is_article("this") || is_article("ant") || is_article("The")));
}
