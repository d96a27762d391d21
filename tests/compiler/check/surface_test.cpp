#include <doctest/doctest.h>

#include "tests/compiler/small_suite.h"

using namespace probe;
using test::analyze_with_suite;

TEST_CASE("an object over the edge or out of reach is reported") {
  CHECK(
      analyze_with_suite("scene s like bench { surface 80cm area (-10cm, -10cm) .. (10cm, 10cm) }\n"
                         "task t like red_on_tray { scene s }")
          ->codes() == "P0505");
  const auto far = analyze_with_suite(
      "robot arm2 { urdf \"arm/arm.urdf\"; tcp tool; fingers left opens +y, right opens -y; "
      "control ee_delta_pose 5Hz; reach 1cm .. 30cm\n"
      "drive waist stiffness 100Nm/rad damping 10Nms/rad limit 20Nm; drive l, r stiffness 1000N/m "
      "damping 200Ns/m limit 60N\n"
      "grip 1cm .. 4cm friction 2 patch 1cm }\n"
      "camera eye2 like eye { mount arm2.base at (0cm, 0cm, 1m) look (1, 0, -1) }\n"
      "scene s like bench { robot arm2 at (50cm, 0cm) yaw 180deg; camera eye2 }\n"
      "task t like red_on_tray { scene s }");
  CHECK_MESSAGE(far->codes() == "P0502", far->said());
}

TEST_CASE("a start over the edge says where the surface ends, unmet starts say their factors") {
  const auto edge = analyze_with_suite(
      "scene s like bench { surface 80cm area (-10cm, -12cm) .. (10cm, 10cm) }\n"
      "task t like red_on_tray { scene s }");
  REQUIRE(edge->codes() == "P0505");
  CHECK(edge->diagnostics.items().front().message ==
        "`red` stands over the edge of `s` in 24 of 24 starts of `t`");
  CHECK(edge->said().find("note: so does `tray`") != std::string::npos);
  CHECK(edge->diagnostics.items().front().labels.back().text ==
        "the surface is x -10cm .. 10cm, y -12cm .. 10cm");
  const auto unmet = analyze_with_suite(
      "layout l like pairs { expect 23 episodes }\ntask t like red_on_tray { layout l }");
  REQUIRE(unmet->codes() == "P0504");
  CHECK(unmet->diagnostics.items().front().message ==
        "`t` has 24 episodes (12 placements x 2 turns), not 23");
}
