#include <doctest/doctest.h>

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
