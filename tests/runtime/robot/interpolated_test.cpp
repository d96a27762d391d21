#include "runtime/robot/interpolated.h"

#include <cmath>

#include "runtime/robot/controller.h"
#include "runtime/robot/rotation.h"
#include "tests/runtime/robot/made_urdf.h"

namespace probe::robot {
namespace {

// An arm of seven joints like the Google robot's, z y z y z y z, and two fingers that turn: they
// close as their positions grow.
const RobotModel& seven_joints() {
  static const RobotModel model = [] {
    std::string text = "<robot name='seven'>" + test::link_text("base", 10);
    std::string parent = "base";
    for (int i = 0; i < 7; ++i) {
      const std::string link = "link" + std::to_string(i);
      text += test::link_text(link, 1) +
              test::joint_text("joint" + std::to_string(i), "revolute", parent, link,
                               i % 2 == 0 ? "0 0 1" : "0 1 0", "0.02 0 0.18", -3, 3);
      parent = link;
    }
    text += test::link_text("tool", 0.1) +
            "<joint name='mount' type='fixed'><parent link='link6'/><child link='tool'/>"
            "<origin xyz='0.004 0.002 0.1635' rpy='0 -1.57 0.3'/></joint>";
    for (const std::string side : {"right", "left"}) {
      text += test::link_text(side, 0.05) +
              test::joint_text(side + "_finger", "revolute", "link6", side,
                               side == "right" ? "1 0 0" : "-1 0 0", "0 0 0.05", -0.0001, 1.3);
    }
    return test::load_text(text + "</robot>");
  }();
  return model;
}

EeControlSpec all_joints() {
  EeControlSpec spec{.tcp_link = "tool", .arm_joints = {}, .finger_joints = {}};
  for (int i = 0; i < 7; ++i) spec.arm_joints.push_back("joint" + std::to_string(i));
  spec.finger_joints = {"right_finger", "left_finger"};
  spec.grip_closed = 1.31;
  spec.grip_open = 0;
  return spec;
}

using Numbers = std::vector<double>;
const Numbers kStart = {-0.26, 0.08, 0.5, 1.16, 0.03, 1.59, -1.08, 0, 0};
const Numbers kStill(9, 0.0);
constexpr int kSubsteps = 171;

InterpolatedController at_start() {
  auto made = InterpolatedController::create(seven_joints(), all_joints(), {});
  REQUIRE_MESSAGE(made.ok(), (made.ok() ? std::string() : to_text(made.failure())));
  made->reset(kStart);
  return std::move(made).value();
}

Numbers copy(std::span<const double> numbers) { return {numbers.begin(), numbers.end()}; }

// All targets of a control step.
std::vector<Numbers> samples(InterpolatedController& law, const ToolAction& action,
                             const Numbers& q, const Numbers& u = kStill) {
  REQUIRE(law.begin(action, q, u, kSubsteps).ok());
  std::vector<Numbers> all;
  for (int i = 0; i < kSubsteps; ++i) {
    law.next();
    all.push_back(copy(law.last()));
  }
  return all;
}

Chain tool_chain() {
  auto chain = Chain::create(seven_joints(), "tool", all_joints().arm_joints);
  REQUIRE(chain.ok());
  return std::move(chain).value();
}

TEST_CASE("a goal begins where the tool is measured, however far it was asked to go before") {
  InterpolatedController law = at_start();
  const Chain chain = tool_chain();
  const Vec3 turn(0.05, -0.1, 0.02);
  for (int i = 0; i < 3; ++i) {
    samples(law, {0.02, -0.01, 0.03, turn.x(), turn.y(), turn.z(), 0}, kStart);
    const Pose now = chain.pose(std::span(kStart).first(7));
    CHECK((law.goal().position - now.position - Vec3(0.02, -0.01, 0.03)).norm() < 1e-12);
    CHECK(pose_error(law.goal(), {law.goal().position, from_rotation_vector(turn) * now.rotation})
              .rotation < 1e-9);
    CHECK(law.reached());
    // As near as the reference's inverse kinematics goes, and no nearer.
    const PoseError left = pose_error(law.goal(), chain.pose(law.goal_joints()));
    CHECK(left.rotation + left.position < 2e-4);
    CHECK(left.rotation + left.position > 1e-6);
  }
}

TEST_CASE("the first path begins where the joints are, the next where the path before was cut") {
  InterpolatedController law = at_start();
  Numbers moving = kStill;
  moving[1] = 9;  // cut to the limit of 1.5
  const auto first = samples(law, {0.05, 0, 0, 0, 0, 0, 0}, kStart, moving);
  CHECK(first[0][0] == doctest::Approx(kStart[0]).epsilon(1e-6));
  CHECK(first[0][1] - kStart[1] == doctest::Approx(1.5 / 513).epsilon(1e-3));
  Numbers lagging = kStart;  // what is measured has nothing to do with the next path's beginning
  const auto second = samples(law, {0, 0, 0, 0, 0, 0, 0}, lagging);
  for (std::size_t j = 0; j < 7; ++j) {
    const double before = first[kSubsteps - 1][j] - first[kSubsteps - 2][j];
    CHECK(std::abs(second[0][j] - first[kSubsteps - 1][j] - before) < 50.0 / (513 * 513));
  }
}

TEST_CASE("the arm's joints arrive together, and a path that is not cut ends at its goal") {
  InterpolatedController law = at_start();
  const auto all = samples(law, {0.004, 0, 0.002, 0, 0, 0.005, 0}, kStart);
  for (std::size_t j = 0; j < 7; ++j)
    CHECK(all.back()[j] == doctest::Approx(law.goal_joints()[j]).epsilon(1e-12));
  // None is there much before another.
  int arrives = -1;
  for (std::size_t j = 0; j < 7; ++j) {
    const double way = law.goal_joints()[j] - kStart[j];
    if (std::abs(way) < 1e-5) continue;
    int at = 0;
    while (std::abs(all[std::size_t(at)][j] - law.goal_joints()[j]) > 1e-3 * std::abs(way)) ++at;
    if (arrives < 0) arrives = at;
    CHECK(std::abs(at - arrives) <= 5);
  }
}

TEST_CASE("closing fingers are told where to be and at what speed; from rest 0.192 rad in a step") {
  InterpolatedController law = at_start();
  const auto all = samples(law, {0, 0, 0, 0, 0, 0, -1}, kStart);
  CHECK(std::abs(all.back()[7] - 0.192) < 6e-4);
  CHECK(all.back()[8] == all.back()[7]);
  CHECK(law.target_speeds()[7] == doctest::Approx(1.0));
  CHECK(law.target_speeds()[0] == 0);  // the arm's damping brakes
}

TEST_CASE("while something is held what presses grows from nothing in each control step") {
  InterpolatedController law = at_start();
  Numbers held = kStart;
  held[7] = held[8] = 0.73;  // a can
  samples(law, {0, 0, 0, 0, 0, 0, -1}, held);
  for (int i = 0; i < 3; ++i) {
    const auto all = samples(law, {0, 0, 0, 0, 0, 0, i == 1 ? 0.0 : -1.0}, held);
    // 200 N m/rad and 8 N m s/rad: the setup's 46 N m at the end.
    CHECK(200 * (all.front()[7] - 0.73) < 0.1);
    CHECK(200 * (all.back()[7] - 0.73) + 8 * law.target_speeds()[7] ==
          doctest::Approx(46.4).epsilon(0.01));
  }
}

TEST_CASE(
    "a goal of the fingers goes on from the last target, by at most all of the way, and a "
    "hundredth past the limit") {
  InterpolatedController law = at_start();
  Numbers q = kStart;
  for (int i = 0; i < 8; ++i) {
    const auto all = samples(law, {0, 0, 0, 0, 0, 0, -7}, q);
    q[7] = q[8] = all.back()[7];
  }
  CHECK(q[7] == doctest::Approx(1.31));
  // Nothing asked for: nothing changes. A little: a little.
  auto all = samples(law, {0, 0, 0, 0, 0, 0, 0.0005}, q);
  CHECK(all.back()[7] == doctest::Approx(1.31));
  all = samples(law, {0, 0, 0, 0, 0, 0, 0.1}, q);
  CHECK(law.save().joint_targets.size() == 19);
  for (int i = 0; i < 8; ++i) {
    all = samples(law, {0, 0, 0, 0, 0, 0, 1}, q);
    q[7] = q[8] = all.back()[7];
  }
  CHECK(q[7] == doctest::Approx(-0.0101));
}

TEST_CASE("a pose that no joints reach leaves the arm's goal where it is measured") {
  InterpolatedController law = at_start();
  const auto all = samples(law, {5, 0, 0, 0, 0, 0, 0}, kStart);
  CHECK(!law.reached());
  for (std::size_t j = 0; j < 7; ++j) CHECK(all.back()[j] == doctest::Approx(kStart[j]));
}

TEST_CASE("saved between control steps it goes on with the same bits") {
  InterpolatedController law = at_start(), other = at_start();
  samples(law, {0.05, 0.02, -0.04, 0.1, 0, 0.2, -1}, kStart);
  REQUIRE(other.restore(law.save()).ok());
  const ToolAction next{0.01, 0, 0, 0, 0.1, 0, 0};
  CHECK(samples(law, next, kStart) == samples(other, next, kStart));
  CHECK(!other.restore({{}, {1, 2}, true}).ok());
}

TEST_CASE("numbers that mean nothing are refused and change nothing") {
  InterpolatedController law = at_start(), other = at_start();
  CHECK(law.begin({0, 0, 0, 0, std::nan(""), 0, 0}, kStart, kStill, 171).failure().message ==
        "action[4] is nan, wanted a rotation vector in radians");
  const ToolAction next{0.01, 0, 0, 0, 0.1, 0, 0};
  CHECK(samples(law, next, kStart) == samples(other, next, kStart));
  EeDeltaInterpolated bad;
  bad.fingers.jerk = 0;
  CHECK(!InterpolatedController::create(seven_joints(), all_joints(), bad).ok());
}

TEST_CASE("fingers that close as their positions grow are open at the low end") {
  auto made = Controller::create(seven_joints(), all_joints(), EeDeltaInterpolated{});
  REQUIRE(made.ok());
  Numbers q = kStart;
  CHECK(made->openness(q) == doctest::Approx(1).epsilon(1e-3));
  q[7] = q[8] = 1.3;
  CHECK(made->openness(q) == doctest::Approx(0));
}

}  // namespace
}  // namespace probe::robot
