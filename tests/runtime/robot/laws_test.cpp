#include "runtime/robot/controller.h"

#include <cmath>
#include <set>

#include "tests/runtime/robot/test_robots.h"

namespace probe::robot {
namespace {

EeControlSpec widowx_joints() {
  return {.tcp_link = "ee_gripper_link", .arm_joints = test::kArm, .finger_joints = test::kFingers};
}

Controller controller(const Law& law) {
  auto made = Controller::create(test::widowx(), widowx_joints(), law);
  REQUIRE_MESSAGE(made.ok(), (made.ok() ? std::string() : to_text(made.failure())));
  made->reset(test::kTableStart);
  return std::move(made).value();
}

OscPose osc_at_home() {
  OscPose law;
  law.home.assign(test::kTableStart.begin(), test::kTableStart.begin() + 6);
  return law;
}

TEST_CASE("each kind of control has a row, a word of its own and a size of its actions") {
  std::set<std::string_view> words;
  for (const KindRow& row : control_kinds()) {
    CHECK(words.insert(row.word).second);
    CHECK(find_kind(row.word) == &row);
  }
  CHECK(find_kind("ee_delta") == nullptr);
  CHECK(known_kinds() ==
        "`ee_delta_pose`, `osc_pose`, `joint_delta`, `joint_position`, "
        "`ee_delta_interpolated`");
  CHECK(controller(EeDeltaPose{}).action_size() == 7);
  CHECK(controller(osc_at_home()).action_size() == 7);
  CHECK(controller(JointDelta{}).action_size() == 7);
  CHECK(row_of(JointPosition{}).action_size(7) == 8);
}

TEST_CASE("`ee_delta_pose` behind the common face gives the same bits") {
  auto alone = EeDeltaPoseController::create(test::widowx(), widowx_joints());
  REQUIRE(alone.ok());
  alone->reset(test::kTableStart);
  Controller common = controller(EeDeltaPose{});
  const ToolAction action{0.01, -0.02, 0.005, 0.1, 0, -0.2, -1};
  for (int i = 0; i < 3; ++i) {
    const auto wanted = alone->targets(action, test::kTableStart);
    REQUIRE(wanted.ok());
    REQUIRE(common.begin(action, test::kTableStart, {}, 100).ok());
    const auto got = common.targets();
    CHECK(std::vector<double>(got.begin(), got.end()) ==
          std::vector<double>(wanted->begin(), wanted->end()));
  }
  CHECK(common.openness(test::kTableStart) == alone->openness(test::kTableStart));
  CHECK(common.save().target.position == alone->save().target.position);
}

TEST_CASE("steps of joints add up in the target or begin where the joint is, within the limits") {
  const std::vector<double> steps{0.1, -0.1, 0, 0, 0, 9, 1};
  std::vector<double> sagged = test::kTableStart;
  sagged[0] += 0.02;
  Controller summed = controller(JointDelta{.from_target = true, .most = 0.5});
  Controller measured = controller(JointDelta{.from_target = false, .most = 0.05});
  for (int i = 0; i < 2; ++i) {
    REQUIRE(summed.begin(steps, sagged, {}, 1).ok());
    REQUIRE(measured.begin(steps, sagged, {}, 1).ok());
  }
  CHECK(summed.targets()[0] == doctest::Approx(test::kTableStart[0] + 0.2));
  CHECK(summed.targets()[5] == doctest::Approx(test::kTableStart[5] + 1.0));
  CHECK(measured.targets()[0] == doctest::Approx(sagged[0] + 0.05));
  CHECK(summed.targets()[6] == doctest::Approx(0.038));
  for (int i = 0; i < 20; ++i) REQUIRE(summed.begin(steps, sagged, {}, 1).ok());
  CHECK(summed.targets()[5] == doctest::Approx(3.141582653589793));
}

TEST_CASE("positions of joints are the targets, kept over save and restore") {
  Controller absolute = controller(JointPosition{});
  const std::vector<double> there{0.3, 0.2, 0.1, 0, -0.1, 9, -1};
  REQUIRE(absolute.begin(there, test::kTableStart, {}, 1).ok());
  CHECK(absolute.targets()[0] == 0.3);
  CHECK(absolute.targets()[5] == doctest::Approx(3.141582653589793));
  CHECK(absolute.targets()[7] == doctest::Approx(0.014));
  Controller other = controller(JointPosition{});
  REQUIRE(other.restore(absolute.save()).ok());
  CHECK(other.targets()[0] == 0.3);
  CHECK(!other.restore({{}, {1, 2}, true}).ok());
}

TEST_CASE("laws with numbers that no controller can have are refused by name") {
  const RobotModel model = test::widowx();
  const auto said = [&](const Law& law) {
    const auto made = Controller::create(model, widowx_joints(), law);
    REQUIRE(!made.ok());
    return made.failure().message;
  };
  OscPose law = osc_at_home();
  law.home.pop_back();
  CHECK(said(law) == "`osc_pose` has 5 home positions for 6 arm joints");
  law = osc_at_home();
  law.kp[2] = -1;
  CHECK(said(law) ==
        "`osc_pose` has a stiffness, damping or output that is negative or not finite");
  law = osc_at_home();
  law.ramp = 1.5;
  CHECK(said(law).ends_with("a ramp that is not between 0 and 1"));
  law = osc_at_home();
  law.grip.limit = std::nan("");
  CHECK(said(law) == "the gripper of `osc_pose` has a negative or non-finite number");
  CHECK(said(JointDelta{.from_target = true, .most = -1}) ==
        "the largest step of `joint_delta` is negative or not finite");
}

TEST_CASE(
    "the gripper's command of `osc_pose` moves at its pace and is kept over save and restore") {
  auto made = OscPoseController::create(test::widowx(), widowx_joints(), osc_at_home());
  REQUIRE(made.ok());
  Dynamics now;
  now.q = now.u = now.bias = JointVector::Zero(6);
  now.mass = MassMatrix::Identity(6, 6);
  now.jacobian = Jacobian::Zero(6, 6);
  std::vector<double> out(8);
  CHECK(made->believed().size() == 6);
  REQUIRE(made->begin(std::vector<double>{0, 0, 0, 0, 0, 0, -0.1}, 25).ok());
  for (int i = 0; i < 30; ++i) made->efforts(now, out);
  CHECK(made->grip_command() == doctest::Approx(0.3));
  CHECK(made->believed().empty());
  // Halfway of the grip, 14 to 38 mm, and three tenths of the half towards open, from where the
  // fingers are (0): at the limit.
  CHECK(out[6] == 20);
  now.all_q[6] = now.all_q[7] = 0.026 + 0.3 * 0.012 + 0.004;
  made->efforts(now, out);
  CHECK(out[6] == doctest::Approx(-1000 * (0.004 - 0.01 * 0.012)));
  const ControlState state = made->save();
  auto other = OscPoseController::create(test::widowx(), widowx_joints(), osc_at_home());
  REQUIRE(other.ok());
  REQUIRE(other->restore(state).ok());
  CHECK(other->grip_command() == made->grip_command());
  CHECK(other->believed().empty());
  CHECK(!other->restore({state.target, {0.1, 0, 0}, true}).ok());
}

}  // namespace
}  // namespace probe::robot
