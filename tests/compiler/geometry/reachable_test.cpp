// Reach by inverse kinematics, with an arm whose reach is plain to see: a lift, a slide outward and
// a slide sideways of at most 30cm each, and a tool that two joints turn down and about.
#include "compiler/geometry/reachable.h"

#include <doctest/doctest.h>

#include "tests/compiler/small_suite.h"

using namespace probe;

namespace {

std::string joint(const std::string& name, const std::string& type, const std::string& parent,
                  const std::string& child, const std::string& axis, const std::string& limits) {
  return "<joint name=\"" + name + "\" type=\"" + type + "\"><parent link=\"" + parent +
         "\"/><child link=\"" + child + "\"/><axis xyz=\"" + axis + "\"/><limit " + limits +
         " effort=\"1\" velocity=\"1\"/></joint>";
}

std::string gantry_urdf() {
  std::string text = "<robot name=\"gantry\">";
  for (const char* link : {"base", "up", "out", "side", "tilt", "hand", "left", "right"}) {
    text += std::string("<link name=\"") + link +
            "\"><inertial><mass value=\"1\"/><inertia ixx=\"0.1\" iyy=\"0.1\" izz=\"0.1\" "
            "ixy=\"0\" ixz=\"0\" iyz=\"0\"/></inertial></link>";
  }
  const std::string slide = "lower=\"-0.3\" upper=\"0.3\"", turn = "lower=\"-3\" upper=\"3\"";
  return text + joint("lift", "prismatic", "base", "up", "0 0 1", slide) +
         joint("reach", "prismatic", "up", "out", "1 0 0", slide) +
         joint("shift", "prismatic", "out", "side", "0 1 0", slide) +
         joint("pitch", "revolute", "side", "tilt", "0 1 0", turn) +
         joint("roll", "revolute", "tilt", "hand", "1 0 0", turn) +
         joint("l", "prismatic", "hand", "left", "0 1 0", slide) +
         joint("r", "prismatic", "hand", "right", "0 -1 0", slide) + "</robot>";
}

std::unique_ptr<test::Analysis> with_gantry(const std::string& layout) {
  test::write_text(test::asset_root() + "/arm/gantry.urdf", gantry_urdf());
  return test::analyze_with_suite(R"(
robot gantry {
  urdf "arm/gantry.urdf"; tcp hand; fingers left opens +y, right opens -y; control ee_delta_pose 5Hz
  drive lift, reach, shift stiffness 1000N/m damping 200Ns/m limit 60N
  drive pitch, roll stiffness 100Nm/rad damping 10Nms/rad limit 20Nm
  drive l, r stiffness 1000N/m damping 200Ns/m limit 60N
  grip 1cm .. 4cm friction 2 patch 1cm
}
camera above { mount gantry.base at (-60cm, 0cm, 1m) look (1, 0, -1); image 64 x 48; lens 20px, 20px, 32px, 24px }
scene hall {
  robot gantry at (0cm, 0cm) yaw 0deg; joints (10cm, 0cm, 0cm, 0.5rad, 0rad, 2cm, 2cm)
  surface 80cm area (-50cm, -50cm) .. (50cm, 50cm); camera above; light day; physics 500Hz friction 1
}
)" + layout + "\ntask t like red_on_tray { scene hall; layout l }");
}

}  // namespace

TEST_CASE("an arm that can point its tool down over every cell is left alone") {
  const auto a = with_gantry("layout l like pairs { drop 9cm }");
  CHECK_MESSAGE(a->codes() == "", a->said());
}

TEST_CASE("a grasp out of reach names object, episode, cell and how far off the tool stays") {
  const auto a = with_gantry(
      "layout l { place source at (42cm, 0cm); place target at (0cm, 0cm); drop 9cm settle 1s }");
  REQUIRE_MESSAGE(a->codes() == "P0502", a->said());
  const Diagnostic& said = a->diagnostics.items().front();
  CHECK(said.message.find("`gantry` cannot grasp `red` from above in `t`: the tool stays 12") == 0);
  CHECK(said.primary_label == "episode 0: red at (42cm, 0cm)");
}

TEST_CASE("a tool that misses a thing's middle by less than half of it may take it elsewhere") {
  const auto red_at = [](const char* x) {
    return with_gantry(std::string("layout l { place source at (") + x +
                       ", 0cm); place target at (0cm, 0cm); drop 9cm settle 1s }");
  };
  // The tool comes to 30 cm; the block is 2 cm high.
  CHECK_MESSAGE(red_at("30.9cm")->codes() == "", red_at("30.9cm")->said());
  CHECK(red_at("31.2cm")->codes() == "P0502");
}

TEST_CASE("a place pose out of reach is one over the target") {
  const auto a = with_gantry(
      "layout l { place source at (0cm, 0cm); place target at (0cm, 40cm); drop 9cm settle 1s }");
  REQUIRE_MESSAGE(a->codes() == "P0502", a->said());
  const Diagnostic& said = a->diagnostics.items().front();
  CHECK(said.message.find("cannot place `red` on `tray` in `t`: the tool stays 10") !=
        std::string::npos);
  CHECK(said.primary_label == "episode 0: tray at (0cm, 40cm)");
}

namespace {

// An arm that moves in the plane, with a lift of 20 cm: four joints. Its tool hangs 10 cm below the
// wrist; of `turned` it points upwards.
std::unique_ptr<test::Analysis> with_scara(const std::string& surface,
                                           const std::string& points = "-z") {
  std::string text = "<robot name=\"scara\">";
  for (const char* link : {"base", "upper", "fore", "wrist", "hand", "left", "right"}) {
    text += std::string("<link name=\"") + link +
            "\"><inertial><mass value=\"1\"/><inertia ixx=\"0.1\" iyy=\"0.1\" izz=\"0.1\" "
            "ixy=\"0\" ixz=\"0\" iyz=\"0\"/></inertial></link>";
  }
  const auto at = [](std::string one, const std::string& xyz) {
    return one.replace(one.find("<axis"), 0, "<origin xyz=\"" + xyz + "\"/>");
  };
  const std::string slide = "lower=\"0\" upper=\"0.2\"", turn = "lower=\"-3\" upper=\"3\"";
  text += at(joint("shoulder", "revolute", "base", "upper", "0 0 1", turn), "0 0 0.4") +
          at(joint("elbow", "revolute", "upper", "fore", "0 0 1", turn), "0.3 0 0") +
          at(joint("lift", "prismatic", "fore", "wrist", "0 0 -1", slide), "0.3 0 0") +
          at(joint("spin", "revolute", "wrist", "hand", "0 0 1", turn), "0 0 -0.1") +
          joint("l", "prismatic", "hand", "left", "0 1 0", slide) +
          joint("r", "prismatic", "hand", "right", "0 -1 0", slide) + "</robot>";
  test::write_text(test::asset_root() + "/arm/scara.urdf", text);
  return test::analyze_with_suite(
      R"(
robot scara {
  urdf "arm/scara.urdf"; tcp hand points )" +
      points + R"(
  fingers left opens +y, right opens -y; control ee_delta_pose 5Hz
  drive shoulder, elbow stiffness 100Nm/rad damping 10Nms/rad limit 20Nm
  drive lift stiffness 1000N/m damping 200Ns/m limit 60N
  drive spin stiffness 100Nm/rad damping 10Nms/rad limit 20Nm
  drive l, r stiffness 1000N/m damping 200Ns/m limit 60N
  grip 1cm .. 4cm friction 2 patch 1cm
}
camera above { mount scara.base at (-60cm, 0cm, 1m) look (1, 0, -1); image 64 x 48; lens 20px, 20px, 32px, 24px }
scene hall {
  robot scara at (-40cm, 0cm, 80cm) yaw 0deg; joints (0rad, 0.5rad, 2cm, 0rad, 2cm, 2cm)
  surface )" +
      surface +
      R"( area (-50cm, -50cm) .. (50cm, 50cm); camera above; light day; physics 500Hz friction 1
}
task t like red_on_tray { scene hall; layout l }
layout l { place source at (0cm, 10cm); place target at (0cm, -10cm); drop 9cm settle 1s })");
}

}  // namespace

TEST_CASE("what is put beside the target need not come over it") {
  const auto solved = [](const char* skill) {
    return with_gantry(
        "layout l { place source at (0cm, 0cm); place target at (0cm, 40cm); drop 9cm settle 1s }\n"
        "task u like red_on_tray { scene hall; layout l; solution { " +
        std::string(skill) + " } }");
  };
  // `t` has no solution.
  const auto told = [](const test::Analysis& a) {
    std::size_t count = 0;
    for (const Diagnostic& said : a.diagnostics.items()) {
      count += said.message.find("in `t`") == std::string::npos && said.code == Code::P0502;
    }
    return count;
  };
  CHECK(told(*solved("put source on target")) > 0);
  CHECK_MESSAGE(told(*solved("put source beside target")) == 0,
                solved("put source beside target")->said());
}

TEST_CASE("an arm of four joints is asked whether its tool comes low enough") {
  // The tool's lowest is 10 cm above the base, which stands at 80 cm.
  const auto low = with_scara("90cm");
  CHECK_MESSAGE(low->codes() == "", low->said());
  const auto high = with_scara("80cm");
  REQUIRE_MESSAGE(high->codes() == "P0502", high->said());
  CHECK(high->diagnostics.items().front().message ==
        "`scara` cannot grasp `red` from above in `t`: the tool comes no lower than 10cm above "
        "the surface there, and has to come to 1cm");
}

TEST_CASE("an arm of four joints whose tool points upwards or aside is told so") {
  const auto up = with_scara("90cm", "+z");
  REQUIRE_MESSAGE(up->codes() == "P0502", up->said());
  CHECK(up->diagnostics.items().front().message.find(
            "the tool points 180deg away from straight down") != std::string::npos);
  CHECK(with_scara("90cm", "+x")->codes() == "P0502");
}

TEST_CASE("an arm of too few joints for any place is not asked") {
  const auto a = test::analyze_with_suite("");
  const auto& scenes = a->model.scenes;
  REQUIRE(scenes.size() == 1);
  CHECK_FALSE(sema::Arm::of(a->model, scenes[scenes.id(0)]).has_value());
}

TEST_CASE("a robot of which no reach is said is near enough everywhere") {
  sema::Robot robot;
  CHECK(sema::is_in_annulus(robot, 9));
  robot.reach_min = 0.1;
  robot.reach_max = 0.5;
  CHECK(sema::is_in_annulus(robot, 0.3));
  CHECK_FALSE(sema::is_in_annulus(robot, 0.05));
  CHECK_FALSE(sema::is_in_annulus(robot, 9));
}
