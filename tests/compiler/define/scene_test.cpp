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

TEST_CASE("a control step is a whole number of physics steps") {
  CHECK(refused("scene s like bench { physics 1000Hz friction 1 }") == "");
  CHECK(refused("scene s like bench { physics 7Hz friction 1 }") == "7Hz");
}

TEST_CASE("joints start within their limits") {
  CHECK(refused("scene s like bench { robot arm at (50cm, 0cm) yaw 180deg; joints (1rad, 2cm, "
                "2cm) }") == "");
  const auto a = analyze_with_suite(
      "scene s like bench { robot arm at (50cm, 0cm) yaw 180deg; joints (1.2rad, 2cm, 2cm) }");
  CHECK(a->underlined() == "joints (1.2rad, 2cm, 2cm)");
  CHECK(a->said().find("joint `waist` starts at 1.2, beyond its limits of -1 and 1") !=
        std::string::npos);
}
