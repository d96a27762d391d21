#include <doctest/doctest.h>

#include <cmath>

#include "tests/compiler/small_suite.h"

using namespace probe;
using test::analyze_with_suite;

namespace {

bool says(const test::Analysis& a, const std::string& text) {
  return a.said().find(text) != std::string::npos;
}

// What is underlined when `declaration` follows the suite; empty when nothing is wrong.
std::string refused(const std::string& declaration) {
  const auto a = analyze_with_suite(declaration);
  if (a->codes().empty()) return {};
  CHECK_MESSAGE(a->codes().substr(0, 5) == "P0304", a->said());
  return a->underlined();
}

}  // namespace

TEST_CASE("a camera's quaternion is made unit, unless it is far from it") {
  const auto a = analyze_with_suite(
      "camera c like eye { mount arm.base at (0m, 0m, 1m) quat (-0.907313, 0.0782, -0.36434, "
      "-0.194741) }\nscene s like bench { camera c }\nvariant v of red_on_tray { scene s }");
  double squares = 0;
  for (const probe::sema::Camera& camera : a->model.cameras) {
    if (camera.name != "c") continue;
    for (const double value : camera.aim_values) squares += value * value;
  }
  CHECK(std::abs(squares - 1) < 1e-15);
  CHECK(refused("camera c like eye { mount arm.base at (0m, 0m, 1m) quat (1, 1, 0, 0) }") ==
        "(1, 1, 0, 0)");
}

TEST_CASE("a scene with another robot is told that it needs a camera of its own") {
  const auto a = analyze_with_suite(
      "robot twin {\n"
      "  urdf \"arm/arm.urdf\"; tcp tool; fingers left opens +y, right opens -y\n"
      "  control ee_delta_pose 5Hz\n"
      "  drive waist stiffness 100Nm/rad damping 10Nms/rad limit 20Nm\n"
      "  drive l, r stiffness 1000N/m damping 200Ns/m limit 60N\n"
      "  grip 1cm .. 4cm friction 2 patch 1cm\n"
      "}\n"
      "scene other like bench { robot twin at (50cm, 0cm) yaw 180deg }\n"
      "variant v of red_on_tray { scene other }");
  CHECK(a->codes() == "P0201");
  CHECK_MESSAGE(says(*a, "camera `eye` of `v` is mounted on a robot that is not in scene `other`"),
                a->said());
  CHECK(says(*a,
             "help: a scene with another robot needs a camera of its own: `camera C { mount "
             "twin.LINK at ... }`, and `camera C` in it"));
}

TEST_CASE("a camera that looks nowhere is told so") {
  const auto a =
      analyze_with_suite("camera c like eye { mount arm.base at (0cm, 0cm, 1m) look (0, 0, 0) }");
  CHECK(a->codes() == "P0304");
  CHECK(says(*a, "a camera looks along a direction, found none"));
}
