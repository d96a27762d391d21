#include <doctest/doctest.h>

#include "tests/compiler/small_suite.h"

using namespace probe;
using test::analyze_with_suite;

TEST_CASE("metrics copy and overwrite in place") {
  const auto a = analyze_with_suite(
      "metrics m { a = once (step > 1); b = max height(source) }\nmetrics n like m { a = at end "
      "(step > 2); c = count (step > 3) }");
  CHECK(a->codes() == "");
  for (const sema::Metrics& metrics : a->model.metrics) {
    if (metrics.name != "n") continue;
    REQUIRE(metrics.items.size() == 3);
    CHECK(metrics.items[0].name == "a");
    CHECK(metrics.items[0].readout == plan::Readout::kAtEnd);
    CHECK(metrics.items[2].name == "c");
  }
}

TEST_CASE("a read-out of a number wants a number and one of a condition a condition") {
  CHECK(analyze_with_suite("metrics m { x = max (step > 1) }")->codes() == "P0601");
  CHECK(analyze_with_suite("metrics m { x = count step }")->codes() == "P0601");
}
