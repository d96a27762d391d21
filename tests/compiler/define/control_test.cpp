// Control laws of robots: what they read, what they lack, and what drives say under them.
#include <doctest/doctest.h>

#include "tests/compiler/small_suite.h"

using probe::test::analyze_with_suite;

namespace {

namespace robot = probe::robot;

std::string arm(const std::string& statements) {
  return "robot other { urdf \"arm/arm.urdf\"; tcp tool; fingers left opens +y, right opens -y\n" +
         statements + " }";
}
const std::string kOsc =
    "control osc_pose 20Hz { home (0.5rad) }\ngrip 0cm .. 4cm\n"
    "drive waist damping 1Nms/rad limit 20Nm\ndrive l, r limit 60N\n";
const std::string kDriven =
    "grip 1cm .. 4cm\ndrive waist stiffness 100Nm/rad damping 10Nms/rad limit 20Nm\n"
    "drive l, r stiffness 1000N/m damping 200Ns/m limit 60N\n";

// The robot called `other`; the analysis must outlive it.
const probe::sema::Robot& other(const probe::test::Analysis& a) {
  for (const probe::sema::Robot& known : a.model.robots) {
    if (known.name == "other") return known;
  }
  static const probe::sema::Robot none;
  return none;
}

// Code and underlined text of the one diagnostic: "P1001 `kp 3`"; empty without any.
std::string said(const std::string& declaration) {
  const auto a = analyze_with_suite(declaration);
  if (a->diagnostics.empty()) return {};
  return a->codes() + " " + a->underlined();
}

std::string with(std::string text, const std::string& part, const std::string& instead) {
  const std::size_t at = text.find(part);
  REQUIRE(at != std::string::npos);
  return text.replace(at, part.size(), instead);
}

// The arm of the small suite without its fingers.
void write_stump() {
  std::string urdf = probe::test::arm_urdf();
  for (const char* joint : {"l", "r"}) {
    const std::string name = std::string("<joint name=\"") + joint + "\" type=\"";
    urdf = with(urdf, name + "prismatic", name + "fixed");
  }
  probe::test::write_text(probe::test::asset_root() + "/arm/stump.urdf", urdf);
}

}  // namespace

TEST_CASE("ee_delta_interpolated has its setup's paths where nothing else is said, and drives") {
  const auto plain = analyze_with_suite(arm("control ee_delta_interpolated 3Hz\n" + kDriven));
  CHECK_MESSAGE(plain->codes() == "", plain->said());
  const auto* law = std::get_if<robot::EeDeltaInterpolated>(&other(*plain).law);
  REQUIRE(law != nullptr);
  CHECK(law->arm == robot::PathLimits{1.5, 2, 50});
  CHECK(law->fingers == robot::PathLimits{1, 7, 50});
  const auto said_so = analyze_with_suite(
      arm("control ee_delta_interpolated 3Hz { arm_path (1, 3, 20); grip_path (2, 4, 9.5) }\n" +
          kDriven));
  law = std::get_if<robot::EeDeltaInterpolated>(&other(*said_so).law);
  REQUIRE(law != nullptr);
  CHECK(law->arm == robot::PathLimits{1, 3, 20});
  CHECK(law->fingers == robot::PathLimits{2, 4, 9.5});
}

TEST_CASE("a path has three numbers above zero, and is read by one law") {
  const auto of = [](const std::string& control) { return said(arm(control + "\n" + kDriven)); };
  CHECK(of("control ee_delta_interpolated 3Hz { arm_path (1, 3) }") == "P0302 (1, 3)");
  CHECK(of("control ee_delta_interpolated 3Hz { grip_path (1, 0, 3) }") == "P0304 0");
  CHECK(of("control ee_delta_pose 3Hz { arm_path (1, 3, 5) }") == "P1001 arm_path (1, 3, 5)");
  CHECK(of("control ee_delta_interpolated 3Hz { kp 3 }") == "P1001 kp 3");
}

TEST_CASE("osc_pose has robosuite's numbers where nothing else is said") {
  const auto a = analyze_with_suite(arm(kOsc));
  CHECK_MESSAGE(a->codes() == "", a->said());
  const auto* law = std::get_if<robot::OscPose>(&other(*a).law);
  REQUIRE(law != nullptr);
  CHECK(law->kp == robot::OscPose{}.kp);
  CHECK(law->output == robot::OscPose{}.output);
  CHECK(law->null_kp == 10);
  CHECK(!law->uncouple);
  CHECK(law->home == std::vector<double>{0.5});
  CHECK(law->grip.limit == 20);
  REQUIRE(other(*a).drives.size() == 3);
  CHECK(other(*a).drives[0].damping == 1);
  CHECK(other(*a).drives[0].stiffness == 0);
  CHECK(!other(*a).drives[0].slides);
  CHECK(other(*a).drives[2].slides);
}

TEST_CASE("one number is for all directions, two for shift and turn, six for each") {
  const auto law_of = [](const std::string& numbers) {
    const auto a = analyze_with_suite(arm(with(kOsc, "home", numbers + "; home")));
    CHECK_MESSAGE(a->codes() == "", a->said());
    const auto* law = std::get_if<robot::OscPose>(&other(*a).law);
    REQUIRE(law != nullptr);
    return *law;
  };
  CHECK(law_of("kp 100").kp == std::array<double, 6>{100, 100, 100, 100, 100, 100});
  CHECK(law_of("kp (100, 50)").kp == std::array<double, 6>{100, 100, 100, 50, 50, 50});
  CHECK(law_of("damping (1, 2, 3, 4, 5, 6)").damping == std::array<double, 6>{1, 2, 3, 4, 5, 6});
  CHECK(law_of("output (2cm, 0.1rad)").output ==
        std::array<double, 6>{0.02, 0.02, 0.02, 0.1, 0.1, 0.1});
  CHECK(law_of("uncouple; ramp 0.2; null 0").uncouple);
  CHECK(said(arm(with(kOsc, "home", "kp (1, 2, 3); home"))) == "P0302 (1, 2, 3)");
  CHECK(said(arm(with(kOsc, "home", "output (5cm, 5cm); home"))) == "P0302 5cm");
}

TEST_CASE(
    "gains are above zero, damping not negative, outputs not zero, ramps a share, rates above "
    "zero") {
  const auto bad = [](const std::string& numbers) {
    return said(arm(with(kOsc, "home", numbers + "; home")));
  };
  CHECK(bad("kp -150") == "P0304 -150");
  CHECK(bad("kp (150, -1)") == "P0304 -1");
  CHECK(bad("kp 0") == "P0304 0");
  CHECK(bad("kp (150, 150, 0, 150, 150, 150)") == "P0304 0");
  CHECK(bad("damping 0") == "");
  CHECK(bad("damping -1") == "P0304 -1");
  CHECK(bad("output (0cm, 0.5rad)") == "P0304 0cm");
  CHECK(bad("null -10") == "P0304 -10");
  CHECK(bad("ramp 1.5") == "P0304 1.5");
  CHECK(said(arm(with(kOsc, "20Hz", "0Hz"))) == "P0304 0Hz");
  CHECK(said(arm(with(kOsc, "limit 20Nm", "limit 0Nm"))) == "P0304 0Nm");
  CHECK(said(arm(with(kOsc, "damping 1Nms/rad", "damping -1Nms/rad"))) == "P0304 -1Nms/rad");
  CHECK(said(arm(with(kOsc, "limit 60N", "limit 60N armature -1kg"))) == "P0304 -1kg");
  CHECK(said(arm(with(kOsc, "4cm", "4cm pace 0"))) == "P0304 0");
}

TEST_CASE("home has a position for each joint of the arm, within its limits") {
  const auto a = analyze_with_suite(arm(with(kOsc, "home (0.5rad)", "home (0.5rad, 1cm)")));
  CHECK(a->codes() == "P1002");
  CHECK(a->underlined() == "(0.5rad, 1cm)");
  CHECK(a->said().find("the arm's joints are `waist`") != std::string::npos);
  CHECK(said(arm(with(kOsc, "home (0.5rad)", "kp 1"))).substr(0, 5) == "P1002");
  CHECK(said(arm(with(kOsc, "0.5rad", "1.5rad"))) == "P0304 1.5rad");
  CHECK(said(arm(with(kOsc, "0.5rad", "1cm"))) == "P0302 1cm");
}

TEST_CASE("what a law does not read is an error at its place") {
  CHECK(said(arm("control ee_delta_pose 5Hz { kp 150 }\n" + kDriven)) == "P1001 kp 150");
  CHECK(said(arm(with("control ee_delta_pose 5Hz\n" + kDriven, "4cm", "4cm limit 20N"))) ==
        "P1001 20N");
  CHECK(said(arm(with(kOsc, "home", "most 0.1rad; home"))) == "P1001 most 0.1rad");
  CHECK(said(arm(with(kOsc, "drive waist", "drive waist stiffness 3Nm/rad"))).substr(0, 5) ==
        "P1001");
}

TEST_CASE("laws of joints are read with their numbers") {
  const auto law = [](const std::string& control) {
    const auto a = analyze_with_suite(arm(control + "\n" + kDriven));
    REQUIRE_MESSAGE(a->codes() == "", a->said());
    return other(*a).law;
  };
  const auto steps = [&](const std::string& numbers) {
    return std::get<robot::JointDelta>(law("control joint_delta 10Hz " + numbers));
  };
  CHECK(steps("").from_target);
  CHECK(steps("").most == 0);
  CHECK(steps("{ from target; most 0.1rad }").from_target);
  CHECK(steps("{ from target; most 0.1rad }").most == 0.1);
  CHECK_FALSE(steps("{ from measured }").from_target);
  CHECK(std::holds_alternative<robot::JointPosition>(law("control joint_position 10Hz")));
  CHECK(said(arm("control joint_delta 10Hz { from nowhere }\n" + kDriven)) == "P0201 nowhere");
  CHECK(said(arm("control joint_delta 10Hz { most 0rad }\n" + kDriven)) == "P0304 0rad");
  CHECK(said(arm("control joint_position 10Hz { most 1rad }\n" + kDriven)) == "P1001 most 1rad");
  CHECK(said(arm("control joint_position 10Hz\n" + with(kDriven, "stiffness 100Nm/rad", "")))
            .substr(0, 5) == "P1002");
}

TEST_CASE("what a law lacks is named") {
  const std::string targets = "control ee_delta_pose 5Hz\n" + kDriven;
  for (const char* part : {"stiffness 100Nm/rad", "damping 10Nms/rad", "limit 20Nm"}) {
    const auto a = analyze_with_suite(arm(with(targets, part, "")));
    CHECK_MESSAGE(a->codes() == "P1002", part, a->said());
  }
  CHECK(said(arm(with(kOsc, "osc_pose", "osc_poes"))).substr(0, 5) == "P0201");
}

TEST_CASE("a joint has friction and an armature in the units of its kind") {
  const std::string targets = "control ee_delta_pose 5Hz\n" + kDriven;
  const auto a = analyze_with_suite(
      arm(with(targets, "limit 20Nm", "limit 20Nm friction 0.1Nm armature 5kgm2")));
  CHECK_MESSAGE(a->codes() == "", a->said());
  REQUIRE(other(*a).drives.size() == 3);
  CHECK(other(*a).drives[0].friction == 0.1);
  CHECK(other(*a).drives[0].armature == 5);
  CHECK(other(*a).drives[1].friction == 0);
  CHECK(said(arm(with(targets, "limit 20Nm", "limit 20Nm armature 5kg"))) == "P0302 5kg");
}

TEST_CASE("a robot may have no fingers; then it has no grip, and metrics ask for none") {
  write_stump();
  const std::string bare =
      "robot stump { urdf \"arm/stump.urdf\"; tcp tool; fingers none; control ee_delta_pose 5Hz\n"
      "drive waist stiffness 100Nm/rad damping 10Nms/rad limit 20Nm }\n";
  const std::string scene =
      "camera stump_eye like eye { mount stump.base at (0cm, 0cm, 1m) look (1, 0, -1) }\n"
      "scene stump_bench like bench { robot stump at (50cm, 0cm) yaw 180deg; joints (0rad); camera "
      "stump_eye }\n";
  const std::string asks =
      "predicate held(o: object) = all f in fingers: impulse(f, o) > 0Ns\n"
      "metrics by_hand like plain { taken = once held(source) }\n";
  CHECK(said(bare) == "");
  CHECK(said(with(bare, "fingers none", "fingers none; grip 1cm .. 4cm")).substr(0, 5) == "P1003");
  CHECK(said(bare + scene + "task fine like red_on_tray { scene stump_bench }") == "");
  const auto a = analyze_with_suite(
      bare + scene + asks + "task no like red_on_tray { scene stump_bench; metrics by_hand }");
  CHECK(a->codes() == "P1003");
  CHECK(a->underlined() == "taken");
  CHECK(a->said().find("metric `taken` asks for fingers, which `stump` has not") !=
        std::string::npos);
  CHECK(a->said().find("by `fingers`") != std::string::npos);
}

TEST_CASE("drives fit the description: each moving joint has one, in the order of actions") {
  const std::string targets = "control ee_delta_pose 5Hz\n" + kDriven;
  CHECK(said(arm(with(targets, "drive l, r", "drive l"))) == "P1004 other");
  CHECK(said(arm(with(targets, "drive l, r", "drive r, l"))) == "P1004 r");
  const std::string one =
      with(arm(targets), "fingers left opens +y, right opens -y", "fingers left opens +y");
  CHECK(said(one) == "P1004 r");
  CHECK(said(with(arm(targets), "tcp tool", "tcp left")) == "P1004 l");
  CHECK(said(with(arm(targets), "tcp tool", "tcp tool points -z")) == "");
  CHECK(said(with(arm(targets), "tcp tool", "tcp tool points +y")) == "P1004 y");
  CHECK(said(with(arm(targets), "tcp tool", "tcp tool points +w")).substr(0, 5) == "P0201");
}

TEST_CASE("air has a density and a viscosity, each in its unit, and arms that feel it") {
  const std::string airy =
      arm(kOsc) +
      "\ncamera other_eye like eye { mount other.base at (0cm, 0cm, 1m) look (1, 0, -1) }\n"
      "@allow(horizon, \"the same steps\")\nvariant windy of red_on_tray { scene airy }\n"
      "scene airy like bench { robot other at (50cm, 0cm) yaw 180deg; camera other_eye\n"
      "physics 500Hz friction 1 air 1.2kg/m3 viscosity 2e-5Pas }";
  CHECK(said(airy) == "");
  CHECK(said("variant windy of red_on_tray { scene airy }\n"
             "scene airy like bench { physics 500Hz friction 1 air 1.2kg/m3 }") ==
        "P1001 1.2kg/m3");
  CHECK(said(with(airy, "2e-5Pas", "2e-5")) == "P0302 2e-5");
  CHECK(said(with(airy, "1.2kg/m3", "-1kg/m3")) == "P0304 -1kg/m3");
}
