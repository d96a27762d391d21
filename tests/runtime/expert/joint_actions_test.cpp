// What a tool's step becomes for an arm that is told its joints, against the tool's own law.
#include "runtime/expert/joint_actions.h"

#include <vector>

#include "runtime/robot/joint_control.h"
#include "tests/runtime/expert/expert_robot.h"

namespace probe::expert {
namespace {

const std::vector<double> kStart = {-0.018, 0.04, 0.222, -0.0046, 1.365, 0.0015, 0.037, 0.037};

// The law's targets behind each of a few steps, and those of `ee_delta_pose`, the joints measured a
// little behind.
template <typename Law>
void check_same_targets(const Law& law) {
  robot::Robot robot = test::widowx();
  robot.law = law;
  auto actions = JointActions::create(robot);
  REQUIRE_MESSAGE(actions.ok(), to_text(actions.failure()));
  auto told = robot::JointController::create(*robot.model, robot.control, law);
  auto tool = robot::EeDeltaPoseController::create(*robot.model, robot.control);
  REQUIRE((told.ok() && tool.ok()));
  std::vector<double> q = kStart;
  actions->begin(q);
  told->reset(q);
  tool->reset(q);
  for (int i = 0; i < 6; ++i) {
    const robot::ToolAction step{0.01, -0.005, 0.004, 0, 0.02, 0.05, i < 3 ? 1.0 : -1.0};
    const auto action = actions->act(step, q);
    REQUIRE_MESSAGE(action.ok(), to_text(action.failure()));
    REQUIRE(action->size() == 7);
    CHECK(action->gripper() == step[robot::kActionGripper]);
    const auto got = told->targets(std::vector<double>(action->begin(), action->end()), q);
    const auto wanted = tool->targets(step, q);
    REQUIRE((got.ok() && wanted.ok()));
    for (std::size_t k = 0; k < q.size(); ++k) CHECK(std::abs((*got)[k] - (*wanted)[k]) < 1e-12);
    for (std::size_t k = 0; k < q.size(); ++k) q[k] += 0.8 * ((*wanted)[k] - q[k]);
  }
}

TEST_CASE("an arm told its joints gets the targets that a tool's law would have given it") {
  check_same_targets(robot::JointPosition{});
  check_same_targets(robot::JointDelta{.from_target = true, .most = 0});
  check_same_targets(robot::JointDelta{.from_target = false, .most = 0});
}

TEST_CASE("what the law clips is asked for again, and what no joints reach is staying") {
  robot::Robot robot = test::widowx();
  robot.law = robot::JointDelta{.from_target = true, .most = 0.02};
  auto actions = JointActions::create(robot);
  REQUIRE(actions.ok());
  actions->begin(kStart);
  double sum = 0, whole = 0;
  {
    robot::Robot free = test::widowx();
    free.law = robot::JointDelta{};
    auto at_once = JointActions::create(free);
    REQUIRE(at_once.ok());
    at_once->begin(kStart);
    whole = (*at_once->act({0, 0.03, 0, 0, 0, 0, 1}, kStart))[0];
  }
  REQUIRE(std::abs(whole) > 0.02);
  for (int i = 0; i < 40; ++i) {
    const auto action = actions->act({0, i == 0 ? 0.03 : 0, 0, 0, 0, 0, 1}, kStart);
    REQUIRE(action.ok());
    for (const double number : action->arm()) CHECK(std::abs(number) <= 0.02);
    sum += (*action)[0];
  }
  CHECK(std::abs(sum - whole) < 1e-9);
  const auto far = actions->act({5, 0, 0, 0, 0, 0, -1}, kStart);
  REQUIRE(far.ok());
  for (const double number : far->arm()) CHECK(std::abs(number) < 1e-9);
  CHECK(far->gripper() == -1);
}

}  // namespace
}  // namespace probe::expert
