#include <doctest/doctest.h>

#include "tests/compiler/small_suite.h"

using namespace probe;
using test::analyze_with_suite;

TEST_CASE("a new object drops the phrase that was chosen for the old one") {
  const auto a = analyze_with_suite(
      "task t like red_on_tray { refer source as loved }\ntask u like t { source blue }");
  CHECK(a->task("t").prompt == "put everybody's darling on the tray");
  CHECK(a->task("u").prompt == "put blue block on the tray");
}
