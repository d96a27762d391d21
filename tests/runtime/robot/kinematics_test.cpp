#include "runtime/robot/kinematics.h"

#include <numbers>

#include "runtime/base/trig.h"
#include "runtime/policy/policy.h"
#include "runtime/robot/rotation.h"
#include "tests/runtime/robot/test_robots.h"

namespace probe::robot {
namespace {

std::vector<std::string> all_joints() {
  std::vector<std::string> names = test::kArm;
  names.insert(names.end(), test::kFingers.begin(), test::kFingers.end());
  return names;
}

double mixed_difference(const Pose& a, const Pose& b) {
  const PoseError e = pose_error(a, b);
  return e.position + e.rotation;
}

TEST_CASE("at zero the WidowX's tool centre point is the sum of its segments") {
  const RobotModel robot = test::widowx();
  const auto chain = Chain::create(robot, "ee_gripper_link", test::kArm);
  REQUIRE(chain.ok());
  const std::vector<double> zero(6, 0);
  const Pose tcp = chain->pose(zero);
  const double x = 0.04975 + 0.175 + 0.075 + 0.065 + 0.043 + 0.023 + 0.027575;
  CHECK((tcp.position - Vec3(x, 0, 0.072 + 0.03865 + 0.25)).norm() < 1e-15);
  CHECK(tcp.rotation.isApprox(Quat::Identity()));
}

TEST_CASE("shoulder, elbow and wrist move the tool by plane trigonometry") {
  const RobotModel robot = test::widowx();
  const auto chain = Chain::create(robot, "ee_gripper_link", test::kArm);
  REQUIRE(chain.ok());
  const double s = 0.4, e = -0.7, w = 1.1, waist = 0.6;
  const std::vector<double> q = {waist, s, e, 0, w, 0};
  // A turn by a about +y takes (x, z) to (x cos a + z sin a, z cos a - x sin a).
  const auto turned = [](double a, double x, double z) {
    const SinCos t = portable_sincos(a);
    return Vec3(x * t.cos + z * t.sin, 0, z * t.cos - x * t.sin);
  };
  const Vec3 flat = Vec3(0, 0, 0.11065) + turned(s, 0.04975, 0.25) + turned(s + e, 0.25, 0) +
                    turned(s + e + w, 0.158575, 0);
  const Pose tcp = chain->pose(q);
  CHECK((tcp.position - axis_rotation(Vec3::UnitZ(), waist) * flat).norm() < 1e-15);
  CHECK(pose_error(tcp, {tcp.position, from_rpy({0, s + e + w, waist})}).rotation < 1e-14);
}

TEST_CASE("at the table scene's start the tool points down in front of the robot") {
  const RobotModel robot = test::widowx();
  const auto chain = Chain::create(robot, "ee_gripper_link", test::kArm);
  REQUIRE(chain.ok());
  const Pose tcp = chain->pose(std::span(test::kTableStart).first(6));
  CHECK((tcp.position - Vec3(0.292069, -0.006091, 0.135321)).norm() < 1e-6);
  const Vec3 down = tcp.rotation * Vec3::UnitX();
  CHECK(down.z() < -0.99);
}

TEST_CASE("tree and chain agree, and the fingers slide apart") {
  const RobotModel robot = test::widowx();
  const auto names = all_joints();
  const auto tree = Tree::create(robot, names);
  const auto chain = Chain::create(robot, "ee_gripper_link", test::kArm);
  REQUIRE(tree.ok());
  REQUIRE(chain.ok());
  policy::Draws draws(7);
  std::vector<Pose> poses(tree->link_count());
  for (int i = 0; i < 50; ++i) {
    std::vector<double> q;
    for (int j = 0; j < 6; ++j) q.push_back(2 * draws.uniform() - 1);
    q.push_back(0.02);
    q.push_back(0.03);
    tree->link_poses(q, poses);
    const auto at = [&](const char* link) { return poses[std::size_t(robot.find_link(link))]; };
    const Pose tcp = chain->pose(std::span(q).first(6));
    CHECK(mixed_difference(at("ee_gripper_link"), tcp) < 1e-13);
    const Pose fingers = at("fingers_link");
    CHECK((fingers.inverse().apply(at("left_finger_link").position) - Vec3(0, 0.02, 0)).norm() <
          1e-15);
    CHECK((fingers.inverse().apply(at("right_finger_link").position) - Vec3(0, -0.03, 0)).norm() <
          1e-15);
  }
}

TEST_CASE("a chain may end in a frame turned against its link, with the same Jacobian") {
  const RobotModel robot = test::widowx();
  const Quat turn = from_rotation_vector({0.3, -1.2, 0.7});
  const auto plain = Chain::create(robot, "ee_gripper_link", test::kArm);
  const auto turned = Chain::create(robot, "ee_gripper_link", test::kArm, turn);
  REQUIRE(plain.ok());
  REQUIRE(turned.ok());
  const std::span<const double> q = std::span(test::kTableStart).first(6);
  Jacobian a, b;
  const Pose there = plain->pose(q, a), seen = turned->pose(q, b);
  CHECK(mixed_difference({there.position, there.rotation * turn}, seen) < 1e-13);
  CHECK((a - b).norm() == 0);
}

TEST_CASE("Jacobians of tree and chain are the derivatives of the pose") {
  const RobotModel robot = test::widowx();
  const auto names = all_joints();
  const auto tree = Tree::create(robot, names);
  REQUIRE(tree.ok());
  const std::vector<double> q = {0.3, -0.2, 0.5, 0.7, 1.0, -0.4, 0.02, 0.025};
  std::vector<Pose> poses(tree->link_count()), moved(tree->link_count());
  tree->link_poses(q, poses);
  for (const char* name : {"ee_gripper_link", "left_finger_link", "wrist_link"}) {
    CAPTURE(name);
    const int link = robot.find_link(name);
    Eigen::MatrixXd jacobian(6, 8);
    tree->jacobian(poses, link, jacobian);
    for (std::size_t j = 0; j < q.size(); ++j) {
      constexpr double kStep = 1e-6;
      std::vector<double> a = q, b = q;
      a[j] -= kStep;
      b[j] += kStep;
      tree->link_poses(a, moved);
      const Pose before = moved[std::size_t(link)];
      tree->link_poses(b, moved);
      const Pose after = moved[std::size_t(link)];
      const auto column = jacobian.col(Eigen::Index(j));
      CHECK(((after.position - before.position) / (2 * kStep) - column.head<3>()).norm() < 1e-9);
      CHECK((to_rotation_vector(after.rotation * before.rotation.conjugate()) / (2 * kStep) -
             column.tail<3>())
                .norm() < 1e-9);
    }
  }
  const auto chain = Chain::create(robot, "ee_gripper_link", test::kArm);
  REQUIRE(chain.ok());
  Jacobian small;
  chain->pose(std::span(q).first(6), small);
  Eigen::MatrixXd whole(6, 8);
  tree->jacobian(poses, robot.find_link("ee_gripper_link"), whole);
  CHECK((whole.leftCols(6) - small).cwiseAbs().maxCoeff() < 1e-14);
}

TEST_CASE("a mimicking finger follows and a joint that is not driven stands still") {
  const test::TextFile file(test::panda_like());
  const auto robot = load_urdf(file.path());
  REQUIRE(robot.ok());
  const std::vector<std::string> names = {"joint1", "joint2", "joint3", "joint4",
                                          "joint5", "joint6", "joint7", "finger1"};
  const auto tree = Tree::create(*robot, names);
  REQUIRE(tree.ok());
  std::vector<Pose> poses(tree->link_count());
  // The arm stretched upwards, the first joint several turns round: it is continuous.
  std::vector<double> q = {4 * std::numbers::pi + 0.5, 0, 0, 0, 0, 0, 0, 0.03};
  tree->link_poses(q, poses);
  const auto at = [&](const char* link) { return poses[std::size_t(robot->find_link(link))]; };
  CHECK((at("link7").position -
         axis_rotation(Vec3::UnitZ(), 0.5) * Vec3(0.088, 0, 0.333 + 0.316 + 0.384))
            .norm() < 1e-12);
  const Pose hand = at("hand");
  CHECK((hand.inverse().apply(at("left").position) - Vec3(0, 0.03, 0.0584)).norm() < 1e-12);
  CHECK((hand.inverse().apply(at("right").position) - Vec3(0, -0.03, 0.0584)).norm() < 1e-12);

  Eigen::MatrixXd jacobian(6, 8);
  tree->jacobian(poses, robot->find_link("right"), jacobian);
  CHECK((jacobian.col(7).head<3>() - hand.rotation * Vec3(0, -1, 0)).norm() < 1e-12);

  const std::vector<std::string> arm_only(names.begin(), names.end() - 1);
  const auto still = Tree::create(*robot, arm_only);
  REQUIRE(still.ok());
  q.pop_back();
  still->link_poses(q, poses);
  CHECK((at("hand").inverse().apply(at("left").position) - Vec3(0, 0, 0.0584)).norm() < 1e-12);
}

TEST_CASE("names that do not fit the chain are told") {
  const RobotModel robot = test::widowx();
  const auto message = [&](const char* link, std::vector<std::string> joints) {
    const auto chain = Chain::create(robot, link, joints);
    REQUIRE(!chain.ok());
    return chain.failure().message;
  };
  CHECK(message("hand", test::kArm) == "no link is named `hand`");
  CHECK(message("ee_gripper_link", {"waste"}) == "no joint is named `waste`");
  CHECK(message("ee_gripper_link", {"waist"}) ==
        "joint `shoulder` lies on the way to `ee_gripper_link`, but is not driven");
  CHECK(message("shoulder_link", {"waist", "elbow"}) ==
        "joint `elbow` is not on the way to the link `shoulder_link`");
  CHECK(message("shoulder_link", {"waist", "waist"}) == "joint `waist` is named twice");
  CHECK(message("shoulder_link", {"ee_arm"}) == "joint `ee_arm` is fixed, it has no position");
}

}  // namespace
}  // namespace probe::robot
