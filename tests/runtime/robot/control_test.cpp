#include "runtime/robot/control.h"

#include <limits>
#include <numbers>

#include "runtime/robot/rotation.h"
#include "tests/runtime/robot/test_robots.h"

namespace probe::robot {
namespace {

EeDeltaPoseController widowx_controller() {
  auto made = EeDeltaPoseController::create(
      test::widowx(),
      {.tcp_link = "ee_gripper_link", .arm_joints = test::kArm, .finger_joints = test::kFingers});
  REQUIRE(made.ok());
  return std::move(made).value();
}

TEST_CASE("a zero action keeps the target pose, wherever the arm has sagged to") {
  EeDeltaPoseController controller = widowx_controller();
  controller.reset(test::kTableStart);
  const Pose before = controller.target_pose();
  std::vector<double> sagged = test::kTableStart;
  sagged[1] += 0.02;
  sagged[4] -= 0.01;
  for (int i = 0; i < 20; ++i) {
    const auto targets = controller.targets(ToolAction{0, 0, 0, 0, 0, 0, 1}, sagged);
    REQUIRE(targets.ok());
    for (std::size_t j = 0; j < 6; ++j) {
      CHECK(std::abs((*targets)[j] - test::kTableStart[j]) < 1e-5);
    }
  }
  CHECK(pose_error(before, controller.target_pose()).position < 1e-14);
  CHECK(pose_error(before, controller.target_pose()).rotation < 1e-14);
}

TEST_CASE("a shift adds up in the target, not in the measured pose") {
  EeDeltaPoseController controller = widowx_controller();
  controller.reset(test::kTableStart);
  const Vec3 before = controller.target_pose().position;
  for (int i = 0; i < 3; ++i) {
    REQUIRE(controller.targets(ToolAction{0.01, 0, -0.005, 0, 0, 0, 1}, test::kTableStart).ok());
  }
  CHECK((controller.target_pose().position - before - Vec3(0.03, 0, -0.015)).norm() < 1e-15);
}

TEST_CASE("a rotation turns the target about the measured position") {
  EeDeltaPoseController controller = widowx_controller();
  controller.reset(test::kTableStart);
  REQUIRE(controller.targets(ToolAction{0.04, 0, 0, 0, 0, 0, 1}, test::kTableStart).ok());
  // The arm has not moved yet: the target is 4 cm in front of p, and a quarter turn swings it to
  // the left of p.
  const Vec3 p = controller.tcp_pose(test::kTableStart).position;
  const Pose before = controller.target_pose();
  REQUIRE(
      controller.targets(ToolAction{0, 0, 0, 0, 0, 0.5 * std::numbers::pi, 1}, test::kTableStart)
          .ok());
  CHECK((controller.target_pose().position - (p + Vec3(0, 0.04, 0))).norm() < 1e-12);
  const Quat turn = from_rotation_vector({0, 0, 0.5 * std::numbers::pi});
  CHECK(pose_error({Vec3::Zero(), turn * before.rotation},
                   {Vec3::Zero(), controller.target_pose().rotation})
            .rotation < 1e-12);
}

TEST_CASE("the joint targets put the tool at the target pose") {
  EeDeltaPoseController controller = widowx_controller();
  controller.reset(test::kTableStart);
  const auto targets =
      controller.targets(ToolAction{0.02, -0.03, 0.01, 0.05, 0, 0.2, 1}, test::kTableStart);
  REQUIRE(targets.ok());
  CHECK(controller.reached());
  const PoseError error = pose_error(controller.tcp_pose(*targets), controller.target_pose());
  CHECK(error.position < 2e-7);
  CHECK(error.rotation < 2e-7);
}

TEST_CASE("out of reach the arm's targets stay while the fingers still obey") {
  EeDeltaPoseController controller = widowx_controller();
  controller.reset(test::kTableStart);
  const auto targets = controller.targets(ToolAction{3, 0, 0, 0, 0, 0, -1}, test::kTableStart);
  REQUIRE(targets.ok());
  CHECK(!controller.reached());
  for (std::size_t j = 0; j < 6; ++j) CHECK((*targets)[j] == test::kTableStart[j]);
  CHECK((*targets)[6] == 0.014);
}

TEST_CASE("the gripper's number maps to finger targets a millimetre past the limits") {
  EeDeltaPoseController controller = widowx_controller();
  controller.reset(test::kTableStart);
  const auto grip = [&](double number) {
    const auto targets =
        controller.targets(ToolAction{0, 0, 0, 0, 0, 0, number}, test::kTableStart);
    REQUIRE(targets.ok());
    CHECK((*targets)[6] == (*targets)[7]);
    return (*targets)[6];
  };
  CHECK(grip(-1) == 0.014);
  CHECK(grip(1) == doctest::Approx(0.038).epsilon(1e-15));
  CHECK(grip(0) == doctest::Approx(0.026).epsilon(1e-15));
  CHECK(grip(7) == grip(1));
  std::vector<double> q = test::kTableStart;
  CHECK(controller.openness(q) == 1);
  q[6] = q[7] = 0.026;
  CHECK(controller.openness(q) == doctest::Approx(0.5));
  q[6] = q[7] = 0.0149;
  CHECK(controller.openness(q) == 0);
}

TEST_CASE("an action that is no number or absurd is named and changes nothing") {
  EeDeltaPoseController controller = widowx_controller();
  controller.reset(test::kTableStart);
  const Pose before = controller.target_pose();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto message = [&](const ToolAction& action) {
    const auto targets = controller.targets(action, test::kTableStart);
    REQUIRE(!targets.ok());
    CHECK(targets.failure().code == Fault::kPolicy);
    return targets.failure().message;
  };
  CHECK(message(ToolAction{0, nan, 0, 0, 0, 0, 0}) == "action[1] is nan, wanted a shift in metres");
  CHECK(message(ToolAction{0, 0, 0, 0, 0, -2000, 0}) ==
        "action[5] is -2000, wanted a rotation vector in radians");
  CHECK(message(ToolAction{0, 0, 0, 0, 0, 0, 1e9}) ==
        "action[6] is 1000000000, wanted the gripper from -1 to 1");
  CHECK(pose_error(before, controller.target_pose()).position == 0);
}

TEST_CASE("names that the robot does not have are told at creation") {
  const RobotModel robot = test::widowx();
  const auto message = [&](const EeControlSpec& spec) {
    const auto made = EeDeltaPoseController::create(robot, spec);
    REQUIRE(!made.ok());
    return made.failure().message;
  };
  CHECK(message({"tool", test::kArm, test::kFingers}) == "no link is named `tool`");
  CHECK(message({"ee_gripper_link", test::kArm, {"thumb"}}) == "no joint is named `thumb`");
  CHECK(message({"base_link", {}, {}}) == "no joint moves the link `base_link`");
}

}  // namespace
}  // namespace probe::robot
