#include <doctest/doctest.h>

#include "tests/compiler/small_suite.h"

using namespace probe;
using test::analyze_with_suite;

TEST_CASE("a photo is of one height of the surface: a scene that moves the surface takes another") {
  const std::string pictured = "scene pictured like bench { camera eye overlay \"wall.png\" }\n";
  const auto lowered = analyze_with_suite(
      pictured +
      "scene low like pictured { surface 72cm area (-50cm, -50cm) .. (50cm, 50cm) }\n"
      "task t like red_on_tray { scene low }");
  REQUIRE_MESSAGE(lowered->codes() == "P0304", lowered->said());
  const Diagnostic& said = lowered->diagnostics.items().front();
  CHECK(said.message == "the surface is at 72cm here and at 80cm in the photo `wall.png`");
  CHECK(lowered->underlined() == "72cm");
  CHECK(lowered->sources.text(said.labels.front().span) == "\"wall.png\"");
  for (const char* fine : {
           "surface 80cm area (-40cm, -40cm) .. (40cm, 40cm)",
           "surface 72cm area (-50cm, -50cm) .. (50cm, 50cm); camera eye",
           "surface 72cm area (-50cm, -50cm) .. (50cm, 50cm); camera eye overlay \"low.png\"",
       }) {
    const auto a = analyze_with_suite(pictured + "scene s like pictured { " + fine +
                                      " }\ntask t like red_on_tray { scene s }");
    CHECK_MESSAGE(a->codes().find("P0304") == std::string::npos, a->said());
  }
}
