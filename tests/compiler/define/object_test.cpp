#include <doctest/doctest.h>

#include "tests/compiler/small_suite.h"

using namespace probe;
using test::analyze_with_suite;

TEST_CASE("a name without words is no name") {
  const auto a = analyze_with_suite("object other like pale { name \"\" }");
  CHECK(a->codes() == "P0406");
  CHECK(a->underlined() == "\"\"");
}
