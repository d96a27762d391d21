#include <doctest/doctest.h>

#include <algorithm>

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

TEST_CASE("extend adds attributes, facts, phrases and datasets to an object, and to its copies") {
  const auto a = analyze_with_suite(
      "attribute material { wood, steel }\nfacts { shiny, heavy }\n"
      "object copy like red { name \"copy\" }\n"
      "extend object red { material wood; is shiny; maybe heavy\n"
      "phrase by_material appearance \"wooden block\" means material wood }\n"
      "extend object red { phrase shine appearance \"shiny block\" means shiny }");
  CHECK_MESSAGE(a->said().find("error") == std::string::npos, a->said());
  for (const char* name : {"red", "copy"}) {
    const auto found = std::ranges::find(a->model.objects, std::string(name), &sema::Object::name);
    REQUIRE(found != a->model.objects.end());
    const sema::Object& object = *found;
    std::size_t added = 0;
    for (const sema::Phrase& phrase : object.phrases)
      added += phrase.name == "by_material" || phrase.name == "shine";
    CHECK(added == 2);
    std::size_t yes = 0, maybe = 0;
    for (const sema::Truth truth : object.facts) {
      yes += truth == sema::Truth::kYes;
      maybe += truth == sema::Truth::kUnknown;
    }
    CHECK(yes >= 1);
    CHECK(maybe >= 1);
  }
}

TEST_CASE("extend never replaces what an object says") {
  const auto refused = [](const std::string& lines, const char* said) {
    const auto a = analyze_with_suite("facts { shiny }\n" + lines);
    CHECK_MESSAGE(a->codes().substr(0, 5) == "P0203", a->said());
    CHECK_MESSAGE(a->said().find(said) != std::string::npos, a->said());
  };
  refused("extend object red { friction 2 }", "is said where `red` is declared");
  refused("extend object red { is shiny }\nextend object red { is shiny }", "is said of `red` already");
  refused("attribute size { big }\nextend object red { size big }\nextend object red { size big }",
          "has a `size` already");
  refused("extend object red { phrase p appearance \"red one\" means shiny }\n"
          "extend object red { phrase p appearance \"one\" means shiny }",
          "has a phrase `p` already");
  const auto nobody = analyze_with_suite("extend object reed { }");
  CHECK_MESSAGE(nobody->codes() == "P0201", nobody->said());
}
