#include <doctest/doctest.h>

#include "tests/compiler/small_suite.h"

using namespace probe;
using test::analyze_with_suite;

TEST_CASE("an object that the camera does not see is doubted once for the task") {
  const std::string narrow =
      "camera narrow like eye { lens 60px, 60px, 32px, 24px }\n"
      "variant v of red_on_tray { camera narrow }";
  const auto a = analyze_with_suite(narrow);
  REQUIRE_MESSAGE(a->codes() == "P0505", a->said());
  CHECK(a->diagnostics.items().front().severity == Severity::kWarning);
  const std::string said = a->diagnostics.items().front().message;
  CHECK_MESSAGE(said.find("the image of `narrow` in `v`; 12 of 48 objects") != said.npos, said);
  CHECK(analyze_with_suite("@allow(out_of_frame, \"why\")\n" + narrow)->diagnostics.has_errors() ==
        false);
  const auto away = analyze_with_suite(
      "camera away like eye { mount arm.base at (0cm, 0cm, 1m) look (-1, 0, -0.1) }\n"
      "variant v of red_on_tray { camera away }");
  REQUIRE_MESSAGE(away->codes() == "P0505", away->said());
  CHECK(away->diagnostics.items().front().message.find("lies behind `away`") != std::string::npos);
}

TEST_CASE("a camera that moves with the arm is not asked what it sees") {
  const auto a = analyze_with_suite(
      "camera hand like eye { mount arm.wrist at (0cm, 0cm, 1m) look (-1, 0, -0.1) }\n"
      "variant v of red_on_tray { camera hand }");
  CHECK_MESSAGE(a->codes() == "", a->said());
}
