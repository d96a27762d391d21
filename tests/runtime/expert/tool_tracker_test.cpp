// The tool under `osc_pose`, led by what its law says of it.
#include "runtime/expert/tool_tracker.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "runtime/robot/action.h"
#include "runtime/robot/rotation.h"

namespace probe::expert {
namespace {

constexpr double kRate = 20;     // Hz
constexpr int kSubsteps = 25;    // of a control step
constexpr double kScale = 0.25;  // m that go with a radian

// A tool that `law` pulls along x and turns about y; where the arm's inertia couples both, one
// mixture of them answers 1 + coupling times as much as a free tool, another 1 - coupling times.
struct Tool {
  robot::OscPose law;
  double coupling = 0;
  double x = 0, turn = 0, v = 0, w = 0;

  Pose pose() const { return {{x, 0, 0}, robot::from_rotation_vector({0, turn, 0})}; }

  void step(const policy::Action& action) {
    const double to_x = x + std::clamp(action[0], -law.output[0], law.output[0]);
    const double to_turn = turn + std::clamp(action[4], -law.output[4], law.output[4]);
    const double kd = 2 * std::sqrt(law.kp[0]), h = 1 / kRate / kSubsteps;
    for (int k = 0; k < kSubsteps; ++k) {
      const double pull = law.kp[0] * (to_x - x) - kd * v;
      const double twist = law.kp[4] * (to_turn - turn) - kd * w;
      v += h * (pull + coupling * kScale * twist);
      w += h * (twist + coupling / kScale * pull);
      x += h * v;
      turn += h * w;
    }
  }
};

// How far the tool is from a goal after so many s, the expert's way: a decision at a time.
double off_after(Tool tool, double seconds) {
  ToolTracker tracker(tool.law, kRate);
  tracker.begin(tool.pose());
  const int decisions = static_cast<int>(seconds * kRate) / tracker.interval();
  for (int d = 1; d <= decisions; ++d) {
    for (int i = 0; i < tracker.interval(); ++i) {
      tracker.observe(tool.pose());
      if (i == 0) tracker.aim({{std::min(0.03 * d, 0.12), 0, 0}, Quat::Identity()}, 1);
      tool.step(tracker.act(1));
    }
  }
  return std::abs(tool.x - 0.12) + kScale * std::abs(tool.turn);
}

}  // namespace

TEST_CASE("the expert decides as often as its moves take the tool under the law") {
  CHECK(ToolTracker(robot::OscPose{}, kRate).interval() == 6);
  robot::OscPose slow;
  slow.output = {0.01, 0.01, 0.01, 0.1, 0.1, 0.1};
  CHECK(ToolTracker(slow, kRate).interval() > 20);
  robot::OscPose loose;
  loose.kp = {0, 150, 150, 150, 150, 150};
  ToolTracker tracker(loose, kRate);
  tracker.begin(Pose{});
  tracker.aim({{0.1, 0.1, 0}, Quat::Identity()}, 1);
  const policy::Action action = tracker.act(1);
  CHECK(action[0] == 0);  // nothing pulls that way
  CHECK(action[1] > 0);
}

TEST_CASE("a free tool is led to its goal, and a stiff or slow law does not upset it") {
  CHECK(off_after({}, 3) < 1e-3);
  Tool stiff;
  stiff.law.kp = {900, 900, 900, 900, 900, 900};
  CHECK(off_after(stiff, 3) < 1e-3);
  Tool soft;
  soft.law.kp = {40, 40, 40, 40, 40, 40};
  CHECK(off_after(soft, 4) < 1e-3);
}

TEST_CASE("a tool whose turns pull at it comes to rest at its goal") {
  // The Panda over a table: 0.11 and 1.89.
  Tool coupled;
  coupled.coupling = 0.89;
  CHECK(off_after(coupled, 5) < 3e-3);
}

TEST_CASE("the gripper has a sign: it stays where it is as wide as it shall be") {
  ToolTracker tracker(robot::OscPose{}, kRate);
  tracker.begin(Pose{});
  tracker.aim(Pose{}, 1);
  CHECK(tracker.act(0.2)[robot::kActionGripper] == 1);
  tracker.aim(Pose{}, -1);
  CHECK(tracker.act(0.2)[robot::kActionGripper] == -1);
  tracker.aim(Pose{}, 0);
  CHECK(tracker.act(0.2)[robot::kActionGripper] == 1);
  CHECK(tracker.act(0.51)[robot::kActionGripper] == 0);
  CHECK(tracker.act(0.8)[robot::kActionGripper] == -1);
}

TEST_CASE("fingers that follow late are set as wide as they shall be, and stay") {
  // Told an eighth of their way a control step, they come half of what is left.
  for (const double wanted : {0.3, 0.55, 0.8}) {
    CAPTURE(wanted);
    ToolTracker tracker(robot::OscPose{}, kRate);
    tracker.begin(Pose{});
    double told = 1, openness = 1;
    int last_moved = 0;
    for (int step = 0; step < 60; ++step) {
      if (step % tracker.interval() == 0) tracker.aim(Pose{}, 2 * wanted - 1);
      const double sign = tracker.act(openness)[robot::kActionGripper];
      if (sign != 0) last_moved = step;
      told = std::clamp(told + 0.125 * sign, 0.0, 1.0);
      openness += 0.4 * (told - openness);
    }
    CHECK(std::abs(openness - wanted) < 0.08);
    CHECK(last_moved < 30);
  }
}

}  // namespace probe::expert
