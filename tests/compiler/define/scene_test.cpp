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

TEST_CASE("a physics rate that no world can bear is refused where it is written") {
  CHECK(refused("scene s like bench { physics 5Hz friction 1 }") == "5Hz");
  CHECK(refused("scene s like bench { physics 40Hz friction 1 }") == "40Hz");
  const auto a = analyze_with_suite("scene s like bench { physics 40Hz friction 1 }");
  CHECK(a->codes() == "P0304");
  CHECK(a->said().find("a physics rate from 50 to 1e+06 Hz") != std::string::npos);
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

TEST_CASE("a scene that copies joints or a rate which do not fit its robot is shown beside them") {
  const auto robot = [](const std::string& name, const std::string& hz, const std::string& drives) {
    return "robot " + name +
           " { urdf \"arm/arm.urdf\"; tcp tool; fingers left opens +y, right opens -y" +
           "; control ee_delta_pose " + hz +
           "Hz\n drive waist stiffness 100Nm/rad damping 10Nms/rad limit 20Nm\n" + drives +
           " grip 1cm .. 4cm friction 2 patch 1cm }\n" + "camera c like eye { mount " + name +
           ".base at (0cm, 0cm, 1m) look (1, 0, -1) }\n" + "scene s like bench { robot " + name +
           " at (50cm, 0cm) yaw 180deg; camera c }";
  };
  const auto a = analyze_with_suite(
      robot("stiff", "7", "drive l, r stiffness 1000N/m damping 200Ns/m limit 60N\n"));
  REQUIRE(a->codes() == "P0304");
  CHECK(a->underlined() == "500Hz");
  CHECK_MESSAGE(a->said().find("controlled at 7Hz: `497Hz` is a multiple") != std::string::npos,
                a->said());
  CHECK_MESSAGE(a->said().find("copied by `s`") != std::string::npos, a->said());
  test::write_text(
      std::filesystem::path(test::asset_root()) / "arm/single.urdf",
      "<robot name=\"single\"><link name=\"base\"/><link name=\"tool\"><inertial><mass "
      "value=\"1\"/><inertia ixx=\"0.1\" iyy=\"0.1\" izz=\"0.1\" ixy=\"0\" ixz=\"0\" "
      "iyz=\"0\"/></inertial></link><joint name=\"waist\" type=\"revolute\"><parent "
      "link=\"base\"/><child link=\"tool\"/><axis xyz=\"0 0 1\"/><limit lower=\"-3\" "
      "upper=\"3\" effort=\"1\" velocity=\"1\"/></joint></robot>");
  const auto joints = analyze_with_suite(
      "robot single { urdf \"arm/single.urdf\"; tcp tool; fingers none; control ee_delta_pose 5Hz\n"
      "drive waist stiffness 100Nm/rad damping 10Nms/rad limit 20Nm }\n"
      "camera c like eye { mount single.base at (0cm, 0cm, 1m) look (1, 0, -1) }\n"
      "scene s like bench { robot single at (50cm, 0cm) yaw 180deg; camera c }");
  CHECK_MESSAGE(joints->said().find("expected 1 joints, one per drive of `single`, found 3") !=
                    std::string::npos,
                joints->said());
  CHECK(joints->said().find("copied by `s`") != std::string::npos);
  CHECK(analyze_with_suite("scene s like bench { joints (1.2rad, 2cm, 2cm) }")
            ->said()
            .find("copied by") == std::string::npos);
}
