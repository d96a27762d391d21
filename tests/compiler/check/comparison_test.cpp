#include <doctest/doctest.h>

#include <bit>

#include "tests/compiler/small_suite.h"

using namespace probe;
using test::analyze_with_suite;

namespace {

bool says(const test::Analysis& a, const std::string& text) {
  return a.said().find(text) != std::string::npos;
}

}  // namespace

TEST_CASE("a confounded comparison marks what moved and names the nearer baseline") {
  const auto a = analyze_with_suite(R"(
variant among of red_on_tray { distractors blue }
variant warned of among against red_on_tray { say "put {source} on {the target}, not {avoid blue}" }
)");
  CHECK_MESSAGE(a->codes() == "P0701", a->said());
  CHECK(says(*a, "language.negation"));
  CHECK(says(*a, "compared with this"));
  CHECK(says(*a, "compare with `among`, where only language.negation moves"));
}

TEST_CASE("a comparison on two axes is a warning unless a reason is given") {
  const char* text = "variant v of red_on_tray { source blue; say take }";
  CHECK(analyze_with_suite(text)->codes() == "P0701");
  const auto allowed =
      analyze_with_suite(std::string("@allow(confounded, \"as published\")\n") + text);
  CHECK(allowed->codes() == "");
  CHECK(allowed->task("v").allow_confounded == "as published");
  CHECK(analyze_with_suite(std::string("@allow(confusing, \"as published\")\n") + text)
            ->codes()
            .find("P0208") != std::string::npos);
}

TEST_CASE("a variant that changes nothing is an error") {
  CHECK(analyze_with_suite("variant v of red_on_tray { source red }")->codes() == "P0702");
}

TEST_CASE("baselines in a circle and abstract tasks in a suite are errors") {
  CHECK(analyze_with_suite("task a like red_on_tray against b { source blue }\ntask b like "
                           "red_on_tray against a { say take }")
            ->codes() == "P0703");
  CHECK(analyze_with_suite("suite s { tasks { base }; seeds 1 }")->codes() == "P0703");
}

TEST_CASE("the same things in the same places, asked of by other roles and phrases, are one contrast") {
  const std::string pair = R"(
layout fixed { place red at (0cm, -20cm); place blue at (0cm, 20cm); place target at (0cm, 0cm)
  orient by rest; drop 10cm settle 0.5s }
task one like red_on_tray { layout fixed; distractors blue }
)";
  const auto other = analyze_with_suite(
      pair + "variant other of one { source blue; distractors red }\n");
  CHECK_MESSAGE(other->codes() == "", other->said());
  CHECK(std::popcount(other->task("other").axes) == 2);
  // A reason that is given is no mistake.
  CHECK(analyze_with_suite(pair + "@allow(confounded, \"a pair\")\n"
                                  "variant other of one { source blue; distractors red }\n")
            ->codes() == "");
  // Something else that moves with it is no contrast any more.
  CHECK(analyze_with_suite(pair + "variant other of one { source blue; distractors red; say take }\n")
            ->codes() == "P0701");
  // As is another place.
  CHECK(analyze_with_suite("task one like red_on_tray { distractors blue }\n"
                           "variant other of one { source blue; distractors red }\n")
            ->codes() == "P0701");
}

TEST_CASE("opposite words with another success are one contrast") {
  const std::string sides = R"(
relation at_left(a: object, b: object) "left" = y(a) > y(b) + 1cm
relation at_right(a: object, b: object) "right" = y(a) < y(b) - 1cm
metrics to_left { success = at end (at_left(source, target) and moved_xy(source) > 3cm) }
metrics to_right { success = at end (at_right(source, target) and moved_xy(source) > 3cm) }
task left like red_on_tray { metrics to_left; say "put {the source} to the left of {the target}" }
)";
  const auto a = analyze_with_suite(
      sides + "variant right of left { metrics to_right; say \"put {the source} to the right of {the target}\" }\n");
  CHECK_MESSAGE(a->codes() == "", a->said());
  CHECK(analyze_with_suite(sides + "variant right of left { metrics to_right; horizon 70 steps\n"
                                   "say \"put {the source} to the right of {the target}\" }\n")
            ->codes() == "P0701");
  CHECK(analyze_with_suite(sides + "variant right of left { metrics to_right\n"
                                   "say \"move {the source} to the right of {the target}\" }\n")
            ->codes() == "P0701");
}
