#include <doctest/doctest.h>

#include "tests/compiler/small_suite.h"

using namespace probe;
using test::analyze_with_suite;

namespace {

// What is underlined when `declaration` follows the suite; empty when nothing is wrong.
std::string refused(const std::string& declaration) {
  const auto a = analyze_with_suite(declaration);
  if (a->codes().empty()) return {};
  CHECK_MESSAGE(a->codes().substr(0, 5) == "P0304", a->said());
  return a->underlined();
}

}  // namespace

TEST_CASE("light has a direction and is not negative") {
  CHECK(refused("light l { ambient 0.3; sun (0, 0, 0) power 1 }") == "(0, 0, 0)");
  CHECK(refused("light l { ambient -3 }") == "-3");
  const std::string vertex = "light l { shading vertex; ";
  CHECK(refused(vertex + "spot at (0m, 0m, 1m) along (0, 0, 0) power 1 }") == "(0, 0, 0)");
  CHECK(refused(vertex + "spot at (0m, 0m, 1m) along (0, 0, -1) power -1 }") == "-1");
  CHECK(refused(vertex + "spot at (0m, 0m, 1m) along (0, 0, -1) power 1 cutoff 91deg }") ==
        "91deg");
  CHECK(refused(vertex + "spot at (0m, 0m, 1m) along (0, 0, -1) power 1 exponent 200 }") == "200");
  CHECK(refused(vertex + "spot at (0m, 0m, 1m) along (0, 0, -1) power 1 fade (0, 0, 0) }") ==
        "(0, 0, 0)");
  CHECK(refused(vertex + "headlight power 1 }").empty());
}
