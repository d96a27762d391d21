#include <doctest/doctest.h>

#include "tests/compiler/small_suite.h"

using namespace probe;
using test::analyze_with_suite;

TEST_CASE("the misuse of a type is reported where it stands") {
  const std::pair<const char*, const char*> cases[] = {
      {"height(source)", "height(source)"},  // a number where a condition is wanted
      {"height(source) > (height(target) > 1cm)",
       "height(target) > 1cm"},                // a condition where a number is wanted
      {"moved_xy(surface) > 1cm", "surface"},  // not an object
      {"impulse(source, height(target)) > 1e-6Ns", "height(target)"},
      {"distance(source, up()) > 1cm", "up()"},  // a direction is no point
      {"impulse(source) > 1e-6Ns", "impulse(source)"},
      {"angle(up(), axis_z(source)) + 1deg < 5deg", "angle(up(), axis_z(source))"},
      {"height > 1cm", "height"},
  };
  for (const auto& [condition, wrong] : cases) {
    CAPTURE(condition);
    const auto a = analyze_with_suite(std::string("metrics m { x = at end (") + condition + ") }");
    CHECK_MESSAGE(a->codes() == "P0601", a->said());
    CHECK(a->underlined() == wrong);
  }
}

TEST_CASE("arguments are matched by place, by name and by default") {
  const char* predicate =
      "predicate near(a: object, b: object, d: length = 3cm, n: number = 1) = distance(a, b) < n * "
      "d\n";
  const auto with = [&](const char* call) {
    return analyze_with_suite(std::string(predicate) + "metrics m { x = at end " + call + " }")
        ->codes();
  };
  CHECK(with("near(source, target)") == "");
  CHECK(with("near(source, target, 1cm)") == "");
  CHECK(with("near(source, target, n: 2)") == "");
  CHECK(with("near(source)") == "P0601");
  CHECK(with("near(source, target, 1cm, 2, 3)") == "P0601");
  CHECK(with("near(source, target, d: 1cm, d: 2cm)") == "P0601");
  CHECK(with("near(source, target, e: 1cm)") == "P0201");
  CHECK(with("near(source, surface)") == "P0601");
}

TEST_CASE("a quantified variable is an object only when its set holds objects alone") {
  CHECK(analyze_with_suite(
            "metrics m { x = at end (any o in objects - {source}: moved_xy(o) > 1cm) }")
            ->codes() == "");
  CHECK(analyze_with_suite("metrics m { x = at end (any o in bodies - links: moved_xy(o) > 1cm) }")
            ->codes() == "P0601");
}

TEST_CASE("measured values compared for equality are a warning") {
  CHECK(analyze_with_suite("metrics m { x = at end (height(source) == 80cm) }")->codes() ==
        "P0606");
  CHECK(analyze_with_suite("metrics m { x = once (step == 1) }")->codes() == "");
}
