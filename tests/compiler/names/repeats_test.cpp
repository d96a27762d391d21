#include <doctest/doctest.h>

#include "tests/compiler/small_suite.h"

using namespace probe;
using test::analyze_with_suite;

TEST_CASE("a statement that would replace one of its own block is refused") {
  const std::pair<const char*, const char*> cases[] = {
      {"task t like red_on_tray { source blue; say \"take {source}\"; say \"put {source}\" }",
       "say \"put {source}\""},
      {"suite s { tasks tasks; tasks tasks; seeds 1 }", "tasks tasks"},
      {"layout l like pairs { drop 1cm; drop 2cm }", "drop 2cm"},
      {"object o like red { maybe favorite; is favorite }", "favorite"},
      {"object o like red { seen in lab; unseen }", "unseen"},
      {"object o like red { density 1kg/m3; density 600kg/m3 }", "density 600kg/m3"},
      {"predicate p(a: object, a: object) = height(a) > 1cm", "a"},
  };
  for (const auto& [text, wrong] : cases) {
    CAPTURE(text);
    const auto a = analyze_with_suite(text);
    CHECK_MESSAGE(a->codes().find("P0203") != std::string::npos, a->said());
    CHECK(a->underlined() == wrong);
  }
}
