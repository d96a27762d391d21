#include <doctest/doctest.h>

#include "tests/compiler/small_suite.h"

using probe::test::analyze_with_suite;

namespace {

// What is underlined when `declaration` follows the suite; empty when nothing is wrong.
std::string refused(const std::string& declaration) {
  const auto a = analyze_with_suite(declaration);
  if (a->codes().empty()) return {};
  CHECK_MESSAGE(a->codes().substr(0, 5) == "P0304", a->said());
  return a->underlined();
}

std::string robot(const std::string& statement) {
  return "robot other { urdf \"arm/arm.urdf\"; tcp tool; control ee_delta_pose 5Hz\n" + statement +
         " }";
}
const std::string kFingers = "fingers left opens +y, right opens -y\n";
const std::string kDrives =
    "drive waist stiffness 100Nm/rad damping 10Nms/rad limit 20Nm\n"
    "drive l, r stiffness 1000N/m damping 200Ns/m limit 60N\n";
const std::string kGrip = "grip 1cm .. 4cm friction 2 patch 1cm\n";

}  // namespace

TEST_CASE("drives hold, damp and push") {
  CHECK(refused(robot(kFingers + kGrip + kDrives)) == "");
  CHECK(refused(robot(kFingers + kGrip +
                      "drive waist stiffness -730Nm/rad damping 1Nms/rad limit 2Nm")) ==
        "-730Nm/rad");
  CHECK(refused(robot(kFingers + kGrip +
                      "drive waist stiffness 730Nm/rad damping 0Nms/rad limit 2Nm")) == "0Nms/rad");
  CHECK(refused(robot(kFingers + kGrip +
                      "drive waist stiffness 730Nm/rad damping 1Nms/rad limit 0Nm")) == "0Nm");
}

TEST_CASE("two fingers are two links, and closed is nearer than open") {
  CHECK(refused(robot("fingers left opens +y, left opens -y\n" + kGrip + kDrives)) == "left");
  CHECK(refused(robot(kFingers + kDrives + "grip 4cm .. 1cm")) == "grip 4cm .. 1cm");
}

TEST_CASE("fingers open apart, each as its joint moves it") {
  CHECK(refused(robot("fingers left opens -y, right opens -y\n" + kGrip + kDrives)) == "left");
  CHECK(refused(robot("fingers left opens +y, right opens +y\n" + kGrip + kDrives)) == "right");
  // A description whose second finger follows the first instead of meeting it.
  std::string urdf = probe::test::arm_urdf();
  const auto axis = urdf.find("0 -1 0");
  REQUIRE(axis != std::string::npos);
  urdf.replace(axis, 6, "0 1 0");
  probe::test::write_text(probe::test::asset_root() + "/arm/same.urdf", urdf);
  const std::string same =
      "robot other { urdf \"arm/same.urdf\"; tcp tool; control ee_delta_pose 5Hz\n" + kGrip +
      kDrives;
  const auto a = analyze_with_suite(same + "fingers left opens +y, right opens +y }");
  CHECK(a->said().find("expected fingers that open apart, found both opening in one direction") !=
        std::string::npos);
  CHECK(refused(same + "fingers left opens +y, right opens -y }") == "right");
}
