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
