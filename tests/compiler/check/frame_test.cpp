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

TEST_CASE("a drawer that a task speaks of and its camera does not see is told, with what helps") {
  const auto open_it = [](const std::string& camera, const std::string& what) {
    return analyze_with_suite(
        std::string(test::kChest) +
        "metrics opened { success = at end slide(chest.drawer) > 8cm }\nlayout alone { drop none }\n"
        "camera other like eye { " + camera + " }\n" + what +
        "task open_it {\n  scene room; layout alone; metrics opened; horizon 60 steps; target chest.drawer\n"
        "  say \"open {the target}\"; camera other\n}\n");
  };
  CHECK_MESSAGE(open_it("", "")->codes() == "", open_it("", "")->said());
  const std::string away = "mount arm.base at (0cm, 0cm, 1m) look (-1, 0, -0.1)";
  const auto behind = open_it(away, "");
  REQUIRE_MESSAGE(behind->codes() == "P0505", behind->said());
  CHECK(behind->diagnostics.items().front().severity == Severity::kWarning);
  CHECK(behind->diagnostics.items().front().message ==
        "`chest.drawer`, of which `open_it` speaks, lies behind `other`");
  const auto narrow = open_it("lens 600px, 600px, 3000px, 240px", "");
  REQUIRE_MESSAGE(narrow->codes() == "P0505", narrow->said());
  CHECK(narrow->said().find("pixels outside the image of `other`") != std::string::npos);
  CHECK(narrow->said().find("help: move the fixture, or turn the camera") != std::string::npos);
  CHECK(open_it(away, "@allow(out_of_frame, \"why\")\n")->codes() == "");
}

TEST_CASE("of several cameras the one that stands still and sees the most of it is named") {
  const auto open_it = [](const std::string& cameras, const std::string& target) {
    return analyze_with_suite(
        std::string(test::kChest) +
        "metrics opened { success = at end slide(chest.drawer) > 8cm }\nlayout alone { drop none "
        "}\n"
        "camera hand  like eye { mount arm.wrist at (0cm, 0cm, 1m) look (-1, 0, -0.1) }\n"
        "camera away  like eye { mount arm.base at (0cm, 0cm, 1m) look (-1, 0, -0.1) }\n"
        "camera aside like eye { lens 600px, 600px, 3000px, 240px }\n"
        "scene seen like room { " +
        cameras +
        " }\n"
        "task open_it {\n  scene seen; layout alone; metrics opened; horizon 60 steps; target " +
        target + "\n  say \"open {the target}\"\n}\n");
  };
  const auto said = [&](const std::string& cameras, const std::string& target = "chest.drawer") {
    const auto a = open_it(cameras, target);
    REQUIRE_MESSAGE(a->codes() == "P0505", a->said());
    return a->diagnostics.items().front().message;
  };
  // The hand's camera comes first and is not asked.
  CHECK(said("camera hand, away") ==
        "`chest.drawer`, of which `open_it` speaks, lies behind `away`");
  const std::string two = said("camera hand, away, aside");
  CHECK_MESSAGE(two.starts_with("`chest.drawer`, of which `open_it` speaks, lies "), two);
  CHECK_MESSAGE(
      two.ends_with("pixels outside the image of `aside`, and no other camera that stands "
                    "still sees it"),
      two);
  // A region is looked for by the part that it belongs to.
  CHECK(said("camera away", "chest.inside") ==
        "`chest.drawer` with `chest.inside`, of which `open_it` speaks, lies behind `away`");
}
