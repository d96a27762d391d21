// Our Google robot against the check numbers of the setup's page.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>

#include "runtime/robot/kinematics.h"
#include "runtime/robot/rotation.h"
#include "tests/runtime/robot/test_robots.h"

namespace probe::robot {
namespace {

const std::vector<std::string> kArmJoints = {"joint_torso",  "joint_shoulder", "joint_bicep",
                                             "joint_elbow",  "joint_forearm",  "joint_wrist",
                                             "joint_gripper"};
const std::vector<double> kStart = {-0.2639457174606611, 0.0831913360274175,   0.5017611504652179,
                                    1.156859026208673,   0.028583671314766423, 1.592598203487462,
                                    -1.080652960128774};

const RobotModel& google_robot() {
  static const RobotModel model = [] {
    auto loaded = load_urdf(VLAPROBE_SOURCE_DIR "/assets/robots/google_robot/google_robot.urdf");
    REQUIRE_MESSAGE(loaded.ok(), (loaded.ok() ? std::string() : to_text(loaded.failure())));
    return std::move(loaded).value();
  }();
  return model;
}

// Every link's pose with the arm at the start and both fingers at one angle.
std::vector<Pose> poses(double finger) {
  std::vector<std::string> joints = kArmJoints;
  std::vector<double> q = kStart;
  for (const char* name : {"joint_finger_right", "joint_finger_left"}) {
    joints.emplace_back(name);
    q.push_back(finger);
  }
  auto tree = Tree::create(google_robot(), joints);
  REQUIRE(tree.ok());
  std::vector<Pose> all(tree->link_count());
  tree->link_poses(q, all);
  return all;
}

Pose of(const std::vector<Pose>& all, const char* link) {
  return all[static_cast<std::size_t>(google_robot().find_link(link))];
}

TEST_CASE("the Google robot's tool and camera begin where the setup's page says") {
  const auto all = poses(0);
  const Pose tool = of(all, "tool"), head = of(all, "link_head_tilt");
  CHECK((tool.position - Vec3(0.439384, -0.218417, 0.961869)).norm() < 2e-6);
  CHECK(tool.rotation.angularDistance(Quat(0.160115, -0.603852, 0.780173, -0.032499)) < 1e-5);
  CHECK((head.apply({0.10488, 0, 0}) - Vec3(0.145990, -0.000417, 1.213358)).norm() < 2e-6);
  CHECK(head.rotation.angularDistance(Quat(0.923929, 0.000547, 0.382562, -0.001321)) < 2e-6);
}

TEST_CASE("the Google robot weighs what the released one weighs, finger tips with their fingers") {
  double mass = 0;
  for (const Link& link : google_robot().links) {
    mass += link.mass;
  }
  const double wanted = 52.9101052160097 + 1.8957478141399 + 1.84719381890442 + 1.24742039827471 +
                        0.646384675806209 + 0.724366583650768 + 0.501929332223751 + 0.40507013 +
                        2 * (0.033324467357629 + 0.0161861871252174) + 0.96335794 +
                        0.879240552641472;
  CHECK(mass == doctest::Approx(wanted).epsilon(1e-9));
}

TEST_CASE("the gap between the Google robot's fingertips is the released one's to 2 mm") {
  std::vector<Vec3> corners;
  std::ifstream file(VLAPROBE_SOURCE_DIR
                     "/assets/robots/google_robot/meshes/finger_tip_collision.obj");
  for (std::string line; std::getline(file, line);) {
    Vec3 v;
    if (std::sscanf(line.c_str(), "v %lf %lf %lf", &v.x(), &v.y(), &v.z()) == 3)
      corners.push_back(v);
  }
  REQUIRE(corners.size() >= 8);
  const std::array<std::array<double, 2>, 6> gaps = {
      {{0, 0.145}, {0.4, 0.108}, {0.73, 0.066}, {0.8, 0.055}, {1.0, 0.014}, {1.07, 0}}};
  for (const auto& [angle, wanted] : gaps) {
    const auto all = poses(angle);
    const Pose hand = of(all, "link_gripper");
    double right = 1e9, left = 1e9;
    for (const Vec3& corner : corners) {
      right =
          std::min(right, -hand.inverse().apply(of(all, "link_finger_right").apply(corner)).y());
      left = std::min(left, hand.inverse().apply(of(all, "link_finger_left").apply(corner)).y());
    }
    CAPTURE(angle);
    CHECK(left == doctest::Approx(right).epsilon(1e-6));
    CHECK(std::abs(left + right - wanted) < 0.002);
  }
}

}  // namespace
}  // namespace probe::robot
