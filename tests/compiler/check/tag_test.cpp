#include <doctest/doctest.h>

#include "tests/compiler/small_suite.h"

using namespace probe;
using test::analyze_with_suite;

namespace {

bool says(const test::Analysis& a, const std::string& text) {
  return a.said().find(text) != std::string::npos;
}

}  // namespace

TEST_CASE("a tag for another data set does not answer for the suite's own") {
  const auto a = analyze_with_suite(
      "dataset other \"Other\"\nsuite s trained on other { tasks { red_on_tray }; seeds 1 }");
  CHECK_MESSAGE(a->codes() == "P0705 P0705", a->said());
  CHECK(says(*a, "does not say whether it was seen in `other`"));
}
