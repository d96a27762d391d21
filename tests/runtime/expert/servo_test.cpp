#include "runtime/expert/servo.h"

#include "runtime/robot/control.h"
#include "runtime/robot/rotation.h"
#include "tests/runtime/expert/fake_table.h"

namespace probe::expert {
namespace {

TEST_CASE("the servo's own target is the controller's, whatever the arm does") {
  test::FakeTable table(test::carrot(-0.2, 0, 0), test::plate(-0.1, 0.1));
  const auto model = robot::load_urdf(test::kUrdf);
  REQUIRE(model.ok());
  const auto chain = robot::Chain::create(*model, "ee_gripper_link", test::kArm);
  REQUIRE(chain.ok());
  Servo servo;
  auto seen = table.observe(0);
  Pose target = seen.proprioception.tcp_in_base;
  servo.begin(*chain, {target, seen.proprioception.joints});
  Pose goal = target;
  goal.position += Vec3(0.08, -0.1, -0.05);
  goal.rotation = robot::from_rotation_vector({0.1, 0, 1.2}) * goal.rotation;
  for (int i = 0; i < 15; ++i) {
    seen = table.observe(i);
    const Pose measured = seen.proprioception.tcp_in_base;
    const Arm arm{measured, seen.proprioception.joints};
    servo.observe(arm, true);
    const policy::Action a = servo.toward(goal, arm, 1, {});
    CHECK(Vec3(a[0], a[1], a[2]).norm() < 0.15);
    CHECK(Vec3(a[3], a[4], a[5]).norm() < 0.61);
    target = robot::moved_target(target, measured.position, {a[0], a[1], a[2]}, {a[3], a[4], a[5]});
    CHECK(robot::pose_error(target, servo.target()).position < 1e-4);
    REQUIRE(table.apply(a).ok());
  }
  const robot::PoseError left =
      robot::pose_error(table.observe(15).proprioception.tcp_in_base, goal);
  CHECK(left.position < 0.001);
  CHECK(left.rotation < 0.005);
}

TEST_CASE("once the drives are known the tool arrives where each step asks") {
  test::FakeTable table(test::carrot(-0.2, 0, 0), test::plate(-0.1, 0.1));
  const auto model = robot::load_urdf(test::kUrdf);
  REQUIRE(model.ok());
  const auto chain = robot::Chain::create(*model, "ee_gripper_link", test::kArm);
  REQUIRE(chain.ok());
  Servo servo;
  auto seen = table.observe(0);
  servo.begin(*chain, {seen.proprioception.tcp_in_base, seen.proprioception.joints});
  Pose goal = seen.proprioception.tcp_in_base;
  goal.position += Vec3(0.1, -0.2, -0.06);
  goal.rotation = robot::from_rotation_vector({0, 0, 1.2}) * goal.rotation;
  for (int i = 0; i < 5; ++i) {
    seen = table.observe(i);
    const Arm arm{seen.proprioception.tcp_in_base, seen.proprioception.joints};
    servo.observe(arm, true);
    const Pace pace{.shift = 0.03, .turn = 0.2};
    REQUIRE(table.apply(servo.toward(goal, arm, 1, pace)).ok());
    const Pose expected = stepped(arm.tcp, goal, pace.shift, pace.turn);
    const robot::PoseError off =
        robot::pose_error(expected, table.observe(i + 1).proprioception.tcp_in_base);
    if (i < 2) continue;
    CHECK(off.position < 0.001);
    CHECK(off.rotation < 0.01);
  }
}

TEST_CASE("what others add to the actions is found out and made up for") {
  test::FakeTable table(test::carrot(-0.2, 0, 0), test::plate(-0.1, 0.1));
  const auto model = robot::load_urdf(test::kUrdf);
  REQUIRE(model.ok());
  const auto chain = robot::Chain::create(*model, "ee_gripper_link", test::kArm);
  REQUIRE(chain.ok());
  Servo servo;
  auto seen = table.observe(0);
  servo.begin(*chain, {seen.proprioception.tcp_in_base, seen.proprioception.joints});
  Pose goal = seen.proprioception.tcp_in_base;
  goal.position += Vec3(0.1, -0.2, -0.06);
  for (int i = 0; i < 20; ++i) {
    seen = table.observe(i);
    const Arm arm{seen.proprioception.tcp_in_base, seen.proprioception.joints};
    servo.observe(arm, true);
    policy::Action action = servo.toward(goal, arm, 1, {});
    if (i == 8) action[1] += 0.03;
    REQUIRE(table.apply(action).ok());
  }
  CHECK(robot::pose_error(table.observe(20).proprioception.tcp_in_base, goal).position < 0.001);
}

TEST_CASE(
    "where the gripper goes on from where it is it closes by steps, and rests once it stands") {
  const auto model = robot::load_urdf(test::kUrdf);
  REQUIRE(model.ok());
  const auto chain = robot::Chain::create(*model, "ee_gripper_link", test::kArm);
  REQUIRE(chain.ok());
  const std::vector<double> joints(chain->joint_count(), 0.1);
  const auto arm = [&](double openness) { return Arm{chain->pose(joints), joints, openness}; };
  Servo servo;
  servo.begin(*chain, arm(1), robot::EeDeltaInterpolated{});
  const auto grip = [&](double openness, double command) {
    return servo.hold(arm(openness), command)[6];
  };
  CHECK(grip(1, kOpenGripper) == kOpenGripper);
  // Somewhere between: as far as it is from there.
  CHECK(grip(1, 0) == doctest::Approx(-0.5));
  const double step = grip(0.5, kClosedGripper);
  CHECK(step < 0);
  CHECK(step > -0.5);
  CHECK(grip(0.4, kClosedGripper) == step);
  CHECK(grip(0.4, kClosedGripper) == 0);
  CHECK(grip(0.39, kClosedGripper) == step);  // what was held gave way
  // It moves on after it was opened, though it stands.
  CHECK(grip(0.39, kOpenGripper) == kOpenGripper);
  CHECK(grip(0.39, kClosedGripper) == step);
}

TEST_CASE("where the law goes on from where the tool is, it is asked to go beyond, but not far") {
  const auto model = robot::load_urdf(test::kUrdf);
  REQUIRE(model.ok());
  const auto chain = robot::Chain::create(*model, "ee_gripper_link", test::kArm);
  REQUIRE(chain.ok());
  const std::vector<double> joints(chain->joint_count(), 0.1);
  const Arm arm{chain->pose(joints), joints, 1};
  Servo servo;
  servo.begin(*chain, arm, robot::EeDeltaInterpolated{});
  const auto asked = [&](const Vec3& way, const Vec3& turn) {
    Pose goal = arm.tcp;
    goal.position += way;
    goal.rotation = robot::from_rotation_vector(turn) * goal.rotation;
    return servo.toward(goal, arm, 1, {.shift = 0.05, .turn = 0.30});
  };
  // Near by: somewhat beyond, the same way.
  const policy::Action near = asked({0.01, 0, -0.02}, {0, 0, 0.1});
  CHECK(near[0] > 0.01);
  CHECK(near[0] < 0.02);
  CHECK(near[2] == doctest::Approx(-2 * near[0]));
  CHECK(near[5] > 0.1);
  CHECK(near[5] < 0.2);
  // Far away: by the pace; half a turn goes on the way that it began.
  const policy::Action far = asked({1, 0, 0}, {0, 0, 3.0});
  CHECK(far[0] < 0.2);
  CHECK(far[0] > 0.05);
  CHECK(far[5] > 0.3);
  CHECK(far[5] < 1);
}

TEST_CASE("a step towards a pose keeps to its limits and ends at the pose") {
  const Pose from;
  const Pose to{Vec3(0.1, 0, 0), robot::from_rotation_vector({0, 0, 1})};
  const robot::PoseError one = robot::pose_error(from, stepped(from, to, 0.03, 0.2));
  CHECK(one.position == doctest::Approx(0.03));
  CHECK(one.rotation == doctest::Approx(0.2));
  CHECK(robot::pose_error(stepped(from, to, 1, 2), to).position < 1e-15);
  CHECK(robot::pose_error(stepped(from, to, 1, 2), to).rotation < 1e-14);
}

}  // namespace
}  // namespace probe::expert
