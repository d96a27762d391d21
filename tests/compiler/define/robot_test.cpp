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

TEST_CASE("a copy of a robot replaces what it says, joint by joint, and keeps the order of the joints") {
  const auto a = analyze_with_suite(
      "robot stiff like arm { drive l stiffness 2000N/m damping 300Ns/m limit 70N }\n"
      "robot slow like stiff { control ee_delta_pose 2Hz; drive waist stiffness 50Nm/rad damping "
      "5Nms/rad limit 9Nm }");
  CHECK_MESSAGE(a->codes() == "", a->said());
  const auto& robots = a->model.robots;
  REQUIRE(robots.size() == 3);
  const auto &arm = robots.begin()[0], &stiff = robots.begin()[1], &slow = robots.begin()[2];
  REQUIRE(stiff.drives.size() == arm.drives.size());
  REQUIRE(slow.drives.size() == arm.drives.size());
  for (std::size_t i = 0; i < arm.drives.size(); ++i) {
    CHECK(stiff.drives[i].joint.text == arm.drives[i].joint.text);
    CHECK(slow.drives[i].joint.text == arm.drives[i].joint.text);
    const bool is_l = arm.drives[i].joint.text == "l", is_waist = arm.drives[i].joint.text == "waist";
    CHECK((stiff.drives[i].stiffness == arm.drives[i].stiffness) == !is_l);
    CHECK((slow.drives[i].stiffness == stiff.drives[i].stiffness) == !is_waist);
  }
  CHECK(slow.control_hz == 2);
  CHECK(stiff.control_hz == arm.control_hz);
  CHECK(slow.urdf.text == arm.urdf.text);
}

TEST_CASE("a description that cannot be read is told with the line that is wrong") {
  const std::string root = probe::test::asset_root();
  probe::test::write_text(std::filesystem::path(root) / "arm/torn.urdf",
                          "<robot name='torn'>\n<link name='a'/>\n<link name='a'/>\n</robot>");
  const auto torn = analyze_with_suite("robot odd like arm { urdf \"arm/torn.urdf\" }");
  CHECK_MESSAGE(torn->said().find("two links are named `a`") != std::string::npos, torn->said());
  CHECK_MESSAGE(torn->said().find("line 3 of `") != std::string::npos, torn->said());
  const auto gone = analyze_with_suite("robot odd like arm { urdf \"arm/gone.urdf\" }");
  CHECK_MESSAGE(gone->said().find("looked for `arm/gone.urdf` in the assets folder") !=
                    std::string::npos,
                gone->said());
}

TEST_CASE("a copy without fingers has no grip either, unless it says one") {
  // The joints of the hand move still.
  const auto bare = analyze_with_suite("robot odd like arm { fingers none }");
  CHECK_MESSAGE(bare->codes() == "P1004", bare->said());
  // Of the copied hand, whose joints its description fixes, no drive is left.
  const std::string root = probe::test::asset_root();
  std::string text = probe::test::arm_urdf();
  for (std::size_t at; (at = text.find("prismatic")) != std::string::npos;)
    text.replace(at, 9, "fixed");
  probe::test::write_text(std::filesystem::path(root) / "arm/handless.urdf", text);
  const auto handless =
      analyze_with_suite("robot odd like arm { urdf \"arm/handless.urdf\"; fingers none }");
  CHECK_MESSAGE(handless->codes() == "", handless->said());
  const auto gripping = analyze_with_suite("robot odd like arm { fingers none; grip 1cm .. 4cm }");
  CHECK_MESSAGE(gripping->codes() == "P1003", gripping->said());
}

TEST_CASE("a jaw that is fixed is no finger, and the message says which are") {
  std::string text = probe::test::arm_urdf();
  const std::string moves = "<joint name=\"r\" type=\"prismatic\"";
  text.replace(text.find(moves), moves.size(), "<joint name=\"r\" type=\"fixed\"");
  probe::test::write_text(std::filesystem::path(probe::test::asset_root()) / "arm/jaw.urdf", text);
  const std::string urdf = "robot odd like arm { urdf \"arm/jaw.urdf\"";
  const auto fixed = analyze_with_suite(urdf + "; fingers left opens +y, right opens -y }");
  CHECK_MESSAGE(fixed->codes() == "P1004", fixed->said());
  CHECK(fixed->underlined() == "right");
  CHECK(fixed->said().find("no drive moves finger `right`: joint `r` is fixed") !=
        std::string::npos);
  CHECK(fixed->said().find("name in `fingers` only those that move: `left`") != std::string::npos);
  const auto one = analyze_with_suite(urdf + "; fingers left opens +y }");
  CHECK_MESSAGE(one->codes() == "", one->said());
}

TEST_CASE("a copy with another hand has the drives of its own joints alone, and says them") {
  const std::string root = probe::test::asset_root();
  std::string text = probe::test::arm_urdf();
  for (const char* finger : {"l", "r"}) {
    const std::string name = "<joint name=\"" + std::string(finger) + "\"";
    text.replace(text.find(name), name.size(), "<joint name=\"jaw_" + std::string(finger) + "\"");
  }
  probe::test::write_text(std::filesystem::path(root) / "arm/jaws.urdf", text);
  const std::string urdf = "robot odd like arm { urdf \"arm/jaws.urdf\"";
  const std::string gains = " stiffness 1000N/m damping 300Ns/m limit 70N }";
  const auto whole = analyze_with_suite(urdf + "; drive jaw_l, jaw_r" + gains);
  CHECK_MESSAGE(whole->codes() == "", whole->said());
  // Unsaid: the joint is named, and what was copied in vain.
  const auto unsaid = analyze_with_suite(urdf + " }");
  CHECK_MESSAGE(unsaid->codes() == "P1004", unsaid->said());
  CHECK_MESSAGE(unsaid->said().find("joint `jaw_l` of `odd` moves, but no `drive` says how") !=
                    std::string::npos,
                unsaid->said());
  CHECK(unsaid->said().find("`l` is no joint that moves there") != std::string::npos);
  // Misspelt: that alone is said.
  const auto misspelt = analyze_with_suite(urdf + "; drive jaww_l, jaw_r" + gains);
  CHECK_MESSAGE(misspelt->codes() == "P0201", misspelt->said());
  CHECK(misspelt->said().find("did you mean `jaw_l`?") != std::string::npos);
}

TEST_CASE("a copy of a robot is told where what it copied does not fit") {
  // The tool is the copied robot's, of a description that this one has not.
  const auto other = analyze_with_suite("robot odd like arm { urdf \"chest/chest.urdf\" }");
  CHECK_MESSAGE(other->said().find("copied by `odd`") != std::string::npos, other->said());
  const auto twice = analyze_with_suite(
      "robot odd like arm { drive l stiffness 2000N/m damping 300Ns/m limit 70N\n"
      "drive l stiffness 1000N/m damping 300Ns/m limit 70N }");
  CHECK(twice->said().find("joint `l` is driven twice") != std::string::npos);
  const auto circle = analyze_with_suite("robot a like b { }\nrobot b like a { }");
  CHECK_MESSAGE(circle->codes() == "P0207", circle->said());
  const auto nobody = analyze_with_suite("robot a like nobody { control ee_delta_pose 2Hz }");
  CHECK_MESSAGE(nobody->codes() == "P0201", nobody->said());
}
