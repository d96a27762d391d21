#include <doctest/doctest.h>

#include "tests/compiler/small_suite.h"

using namespace probe;
using test::analyze_with_suite;

TEST_CASE("what is wrong with a start is said of what came in, when the layout was fine before") {
  const auto overlap = analyze_with_suite(
      "object wide like blue { mesh \"block\"; box 60cm x 60cm x 2cm; name \"w\" }\n"
      "variant v of red_on_tray { source wide }");
  CHECK_MESSAGE(overlap->codes().starts_with("P0501"), overlap->said());
  CHECK(overlap->underlined() == "wide");
  const auto cells = analyze_with_suite(
      "object b1 like blue { name \"b1\" }\nobject b2 like blue { name \"b2\" }\n"
      "variant v of red_on_tray { distractors blue, b1, b2 }");
  CHECK_MESSAGE(cells->codes() == "P0503", cells->said());
  CHECK(cells->underlined() == "distractors blue, b1, b2");
}
