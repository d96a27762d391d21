#include <doctest/doctest.h>

#include "tests/compiler/small_suite.h"

using namespace probe;
using test::analyze_with_suite;

TEST_CASE("a name without words is no name") {
  const auto a = analyze_with_suite("object other like pale { name \"\" }");
  CHECK(a->codes() == "P0406");
  CHECK(a->underlined() == "\"\"");
}

TEST_CASE("a name of blanks has no words, and nothing in a name or phrase is hidden") {
  CHECK(analyze_with_suite("object other like pale { name \" \" }")->codes() == "P0406");
  const auto a = analyze_with_suite("object other like pale { name \"red\u200b block\" }");
  CHECK(a->codes() == "P0304");
  CHECK_MESSAGE(a->said().find("holds the invisible character U+200B") != std::string::npos,
                a->said());
  const auto b = analyze_with_suite(
      "object other like pale { phrase p appearance \"a \u202ething\" means color red }");
  CHECK(b->codes() == "P0304");
  CHECK(b->underlined() == "\"a \u202ething\"");
  CHECK(analyze_with_suite(
            "object other like pale { phrase p appearance \"  \" means category dish }")
            ->codes() == "P0406");
}
