#include <doctest/doctest.h>

#include "tests/compiler/small_suite.h"

using namespace probe;
using test::analyze_with_suite;

TEST_CASE("read-outs that mean something else than they seem to") {
  const auto codes = [](const std::string& metric) {
    return analyze_with_suite("metrics m { x = " + metric + " }")->codes();
  };
  CHECK(codes("at end impulse(source, target) > 1e-6Ns") == "P0605");
  CHECK(codes("at end (any f in fingers: impulse(f, source) > 1e-6Ns)") == "P0605");
  CHECK(codes("once (not height(source) > 1m)") == "P0605");
  CHECK(codes("once (once height(source) > 1m)") == "P0605");
  CHECK(codes("always (not height(source) > 1m)") == "");
  CHECK(codes("once impulse(source, target) > 1e-6Ns") == "");
  CHECK(codes("at end height(source) == height(target)") == "P0606");
}

TEST_CASE("a hold that is longer than the horizon can never become true") {
  const auto a = analyze_with_suite(
      "metrics m like plain { steady = once (speed(source) < 1e-3 * speed(target) for 80 steps) "
      "}\ntask t "
      "like red_on_tray { metrics m }");
  CHECK_MESSAGE(a->codes() == "P0604", a->said());
  CHECK(a->underlined() == "for 80 steps");
}
