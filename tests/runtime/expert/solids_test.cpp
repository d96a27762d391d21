#include <doctest/doctest.h>

#include <array>
#include <numbers>

#include "runtime/expert/around_solid.h"
#include "runtime/expert/holds.h"
#include "runtime/expert/solids.h"
#include "runtime/robot/hands.h"
#include "runtime/robot/rotation.h"
#include "tests/runtime/expert/fake_table.h"

namespace probe::expert {
namespace {

// A drawer that slides along y, 20 cm square and 6 cm high, open towards the base's -y.
policy::Privileged drawer_with(std::vector<policy::PrivilegedObject> objects) {
  policy::Privileged view;
  policy::PrivilegedFixture drawer;
  drawer.name = "drawer";
  drawer.parts = {test::block({-0.10, -0.10, 0.00}, {0.10, 0.10, 0.01}),
                  test::block({-0.10, -0.10, 0.01}, {0.10, -0.09, 0.06})};
  drawer.pose.position = {0.5, 0, 0.1};
  policy::PrivilegedFixture::Joint joint;
  joint.slides = true;
  joint.axis = Vec3::UnitY();
  joint.upper = 0.16;
  joint.closed = 0.16;
  drawer.joint = joint;
  view.fixtures.push_back(drawer);
  view.objects = std::move(objects);
  return view;
}

policy::PrivilegedObject cup_at(const Vec3& position) {
  return test::object("cup", {test::block({-0.03, -0.03, 0}, {0.03, 0.03, 0.08})}, position, 0);
}

}  // namespace

TEST_CASE("what stands in a drawer goes along with it, what stands beside does not") {
  const policy::Privileged view = drawer_with({cup_at({0.5, 0, 0.11}), cup_at({0.5, 0.30, 0.0})});
  const Surroundings around = surroundings_of(view);
  const std::array<Ball, 1> ball = {Ball{Vec3::Zero(), 0.01}};
  const auto room_at = [&](double y, const MovedPart& moved) {
    return around.clearance({{0.5, y, 0.18}, Quat::Identity()}, ball, 1.0, moved);
  };
  const Pose moved{{0.5, 0.16, 0.1}, Quat::Identity()};
  CHECK(room_at(0, {}) < 0);             // in the cup, as it stands
  CHECK(room_at(0, {0, moved}) > 0.05);  // it is gone from there with the drawer...
  CHECK(room_at(0.16, {0, moved}) < 0);  // ...to here
  CHECK(room_at(0.30, {0, moved}) == doctest::Approx(room_at(0.30, {})).epsilon(1));
}

TEST_CASE("a drawer with a cup in it is closed by a push that leads where the cup was") {
  policy::Privileged view = drawer_with({cup_at({0.5, -0.03, 0.11})});
  const Surroundings around = surroundings_of(view);
  HoldProblem problem;
  problem.around = &around;
  problem.fixture = 0;
  problem.joint = *view.fixtures[0].joint;
  problem.aim = 0.16;
  problem.now = Quat::Identity();
  problem.grasps = false;
  problem.hand.tip_below = 0.01;
  problem.hand.palm_above = 0.05;
  problem.hand.finger_half = 0.01;
  problem.hand.opening_half = 0.04;
  problem.hand.outside_half = 0.055;
  problem.hand.palm_half = 0.05;
  problem.hand.palm_back = problem.hand.palm_front = 0.02;
  const std::vector<Hold> holds = hold_candidates(problem);
  CHECK(std::ranges::any_of(holds, [](const Hold& hold) { return hold.pushes(); }));

  // Under a board that the drawer goes under, only a hand that leans back has room.
  policy::PrivilegedFixture board;
  board.name = "board";
  board.parts = {test::block({-0.2, 0.05, 0.17}, {0.2, 0.30, 0.40})};
  board.pose.position = {0.5, 0, 0};
  view.fixtures.push_back(board);
  const Surroundings below = surroundings_of(view);
  problem.around = &below;
  const std::vector<Hold> leant = hold_candidates(problem);
  REQUIRE_FALSE(leant.empty());
  for (const Hold& hold : leant) CHECK((hold.turned * Vec3::UnitX()).z() > -0.95);
}

TEST_CASE("a drawer that has nothing to hold is drawn by its front's upper edge") {
  // Shut under a top, 8 cm over its front; it opens towards the base.
  policy::Privileged view = drawer_with({});
  policy::PrivilegedFixture& drawer = view.fixtures[0];
  drawer.pose = {{0.6, 0, 0.1}, robot::from_rotation_vector({0, 0, -0.5 * std::numbers::pi})};
  drawer.joint->position = drawer.joint->closed;
  policy::PrivilegedFixture top;
  top.name = "top";
  top.parts = {test::block({-0.10, -0.12, 0}, {0.10, 0.12, 0.02}),
               test::block({0.08, -0.12, -0.14}, {0.12, 0.12, 0})};  // and a back
  top.pose.position = {0.6, 0, 0.24};
  view.fixtures.push_back(top);
  const Surroundings around = surroundings_of(view);
  HoldProblem problem;
  problem.around = &around;
  problem.fixture = 0;
  problem.joint = *drawer.joint;
  problem.aim = 0.06;
  problem.now = tool_frame(-Vec3::UnitZ(), Vec3::UnitY());
  problem.hand = robot::known_hand("wx250s")->shape;
  problem.hooks = true;
  const std::vector<Hold> holds = hold_candidates(problem);
  REQUIRE(!holds.empty());
  for (const Hold& hold : holds) {
    CHECK(hold.reaches_over());
    const Pose tool = tool_at(hold, drawer.pose, problem.hand);
    const Vec3 down = tool.rotation * Vec3::UnitX();
    CHECK(down.x() > 0.3);   // over the edge, from the base's side
    CHECK(down.z() < -0.3);  // behind it
    const Vec3 tips = tool.position + problem.hand.tip_below * down;
    CHECK(tips.x() > 0.51);                          // the front is 0.50 to 0.51
    CHECK(tips.z() < 0.16);                          // and up to 0.16 high
    CHECK((tool.position - 0.1 * down).x() < 0.55);  // the palm is before it
  }
  // Nothing is drawn that turns.
  problem.joint.slides = false;
  CHECK(hold_candidates(problem).empty());
}

}  // namespace probe::expert
