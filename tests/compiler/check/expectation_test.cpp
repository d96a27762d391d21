#include <doctest/doctest.h>

#include "tests/compiler/small_suite.h"

using namespace probe;
using test::analyze_with_suite;

TEST_CASE("sets, suites and derives without tasks, seeds twice or not at all") {
  const auto codes = [](const std::string& text) { return analyze_with_suite(text)->codes(); };
  CHECK(codes("set s = tasks where has distractors") == "P0211");
  CHECK(codes("@allow(empty, \"a later release\")\nset s = tasks where has distractors") == "");
  CHECK(codes("derive \"{t}_x\" for t in tasks where has distractors { light night }") == "P0211");
  CHECK(codes("derive \"{t}_{p}\" for t in tasks, p in phrases commonsense of target "
              "{ refer target as p }") == "P0211");
  CHECK(codes("suite s { tasks tasks where has distractors; seeds 1 }") == "P0211");
  CHECK(codes("suite s { tasks tasks; seeds 1, 2, 1 }") == "P0203");
  CHECK(codes("suite s { tasks tasks }") == "P0206");
  CHECK(codes("suite s { tasks { base }; seeds 1 }") == "P0703");
  CHECK(codes("derive \"{t}_x\" for t in { base } { light night }") == "P0703");
}

TEST_CASE("a suite that expects other numbers is told the real ones") {
  const auto a =
      analyze_with_suite("suite s { tasks tasks; seeds 1; expect 2 tasks, 48 episodes }");
  CHECK(a->codes() == "P0504");
  CHECK(a->diagnostics.items().front().message == "suite `s` has 1 tasks and 24 episodes");
  CHECK(analyze_with_suite("suite s { tasks tasks; seeds 1; expect 1 tasks, 24 episodes }")
            ->codes() == "");
}

TEST_CASE("what a copied layout expects is said of the copy") {
  const auto a = analyze_with_suite(
      "layout wide like pairs { expect 24 episodes }\n"
      "layout narrow like wide { cells spots = grid 1 x 2 at (0cm, 0cm) spread (0cm, 10cm) }\n"
      "task t like red_on_tray { layout narrow }");
  REQUIRE_MESSAGE(a->codes() == "P0504", a->said());
  REQUIRE(a->diagnostics.items().front().helps.size() == 1);
  CHECK(a->diagnostics.items().front().helps[0] ==
        "`narrow` copies what `wide` expects: write `expect 4 episodes` into it");
}

TEST_CASE("a task where a set is asked for gets its braces") {
  const auto a = analyze_with_suite("suite s { tasks red_on_tray; seeds 1 }");
  REQUIRE_MESSAGE(a->codes() == "P0201", a->said());
  REQUIRE(a->diagnostics.items().front().fix);
  CHECK(a->diagnostics.items().front().fix->replacements[0].text == "{ red_on_tray }");
}
