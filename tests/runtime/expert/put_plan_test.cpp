#include <doctest/doctest.h>

#include <array>
#include <numbers>

#include "runtime/expert/put_plan.h"
#include "runtime/expert/servo.h"
#include "runtime/expert/tool_way.h"
#include "tests/runtime/expert/expert_robot.h"
#include "tests/runtime/expert/fake_table.h"

namespace probe::expert {
namespace {

// In the base frame, which is the world's here.
constexpr double kTop = 0.0;

// 3.6 cm wide, 8 cm high, with a handle towards the robot.
policy::PrivilegedObject cup_at(const Vec3& position) {
  return test::object("cup",
                      {test::block({-0.018, -0.018, 0}, {0.018, 0.018, 0.08}),
                       test::block({-0.008, -0.045, 0.035}, {0.008, -0.018, 0.07})},
                      position, -90);
}

// Open to the robot: floor, two sides, a back and, if asked, a roof 11 cm above the floor.
policy::PrivilegedFixture oven_at(const Vec3& position, bool has_roof) {
  policy::PrivilegedFixture oven;
  oven.name = "oven";
  oven.parts = {test::block({-0.08, -0.05, 0}, {0.08, 0.06, 0.01}),
                test::block({-0.08, -0.05, 0.01}, {-0.07, 0.06, 0.12}),
                test::block({0.07, -0.05, 0.01}, {0.08, 0.06, 0.12}),
                test::block({-0.07, 0.05, 0.01}, {0.07, 0.06, 0.12})};
  if (has_roof) oven.parts.push_back(test::block({-0.08, -0.05, 0.12}, {0.08, 0.06, 0.13}));
  oven.pose = {position, robot::from_rotation_vector({0, 0, -0.5 * std::numbers::pi})};
  return oven;
}

struct Case {
  policy::Privileged view;
  policy::Skill skill;
  Scene scene;
  Reach reach;
};

Case case_of(policy::PrivilegedObject object, policy::PrivilegedFixture fixture,
             const policy::Skill::Box& region) {
  auto reach = Reach::create(test::widowx());
  REQUIRE(reach.ok());
  Case out{{}, {}, {}, std::move(reach).value()};
  out.view.objects.push_back(std::move(object));
  out.view.fixtures.push_back(std::move(fixture));
  out.view.surface_z = kTop;
  out.skill.kind = policy::Skill::Kind::kPut;
  out.skill.place = policy::Skill::Place::kIn;
  out.skill.object = 0;
  out.skill.to_fixture = 0;
  out.skill.region = region;
  policy::Observation seen;
  const std::vector<double> joints = {0, 0, 0.2, 0, 1.3, 0};
  seen.proprioception = {out.reach.chain().pose(joints), 1, joints};
  seen.privileged = &out.view;
  out.scene = look(seen, {0, -1}, out.reach.hand());
  return out;
}

const policy::Skill::Box kInside{{-0.06, -0.04, 0.005}, {0.06, 0.04, 0.11}, {}};

std::optional<PutPlan> planned(const Case& c) {
  const std::vector<PutPlace> places = find_put_places(c.scene, c.view, c.skill);
  return plan_put({&c.scene, &c.view, &c.reach, 0, places, {}});
}

Vec3 way_down(const Pose& tool) { return tool.rotation * Vec3::UnitX(); }

}  // namespace

TEST_CASE("what goes under a roof is taken from a side and goes in from where it is open") {
  const Case c = case_of(cup_at({0.37, 0.0, kTop}), oven_at({0.54, 0.0, kTop}, true), kInside);
  CHECK(find_put_spots(c.scene, c.view, c.skill, c.reach).empty());
  const std::optional<PutPlan> plan = planned(c);
  REQUIRE(plan.has_value());
  const Pose& end = plan->carry.back();
  CHECK(way_down(end).x() > 0.4);
  // Its last leg is level and goes in, with the cup as it stood.
  const Vec3 leg = end.position - plan->carry[plan->carry.size() - 2].position;
  CHECK(leg.x() > 0.05);
  CHECK(std::abs(leg.z()) < 1e-6);
  CHECK((plan->put.rotation * Vec3::UnitZ()).z() == doctest::Approx(1));
  CHECK(plan->put.position.x() > 0.54 - 0.04 - 1e-6);
  CHECK(plan->put.position.x() < 0.54 + 0.04);
  CHECK(plan->put.position.z() > 0.01);
  CHECK(plan->put.position.z() < 0.02);
}

TEST_CASE("where the mouth is shut there is no plan, and none is made up") {
  policy::PrivilegedFixture oven = oven_at({0.54, 0.0, kTop}, true);
  oven.parts.push_back(test::block({-0.08, -0.06, 0}, {0.08, -0.05, 0.13}));
  const Case c = case_of(cup_at({0.37, 0.0, kTop}), std::move(oven), kInside);
  CHECK_FALSE(planned(c).has_value());
}

TEST_CASE("what stands half under a board comes out along the table before it is lifted") {
  policy::PrivilegedFixture board;
  board.name = "board";
  board.parts = {test::block({-0.10, 0.0, 0.105}, {0.10, 0.20, 0.115}),
                 test::block({-0.10, 0.19, 0.0}, {0.10, 0.20, 0.105})};
  board.pose = {{0.38, 0, kTop}, robot::from_rotation_vector({0, 0, -0.5 * std::numbers::pi})};
  // To another part of the table.
  Case c = case_of(cup_at({0.38, 0, kTop}), std::move(board),
                   {{0.25, -0.25, -0.01}, {0.35, -0.15, 0.05}, {}});
  c.skill.to_fixture = -1;
  const std::optional<PutPlan> plan = planned(c);
  REQUIRE(plan.has_value());
  const Pose& hold = plan->to_hold.back();
  const Vec3 first = plan->carry.front().position - hold.position;
  CHECK(first.head<2>().norm() > 0.05);
  CHECK(first.z() < 0.01);
  CHECK(first.x() < 0.01);
  CHECK(plan->put.position.y() < -0.15);
}

TEST_CASE("holds that were tried are taken last") {
  const Case c = case_of(cup_at({0.37, 0.0, kTop}), oven_at({0.54, 0.0, kTop}, false), kInside);
  const std::optional<PutPlan> first = planned(c);
  REQUIRE(first.has_value());
  const std::vector<PutPlace> places = find_put_places(c.scene, c.view, c.skill);
  const std::array<Pose, 1> failed = {first->hold};
  const std::optional<PutPlan> next = plan_put({&c.scene, &c.view, &c.reach, 0, places, failed});
  REQUIRE(next.has_value());
  CHECK_FALSE(is_near(first->hold, next->hold, 0.01, 0.3));
}

TEST_CASE("a tool's way is gone pose by pose, and says where the tool comes no nearer") {
  const auto at = [](double x) { return Pose{{x, 0, 0}, Quat::Identity()}; };
  ToolWay way;
  way.begin({at(0.1), at(0.2), at(0.3)}, 0.004, 0.010);
  CHECK(way.advance(at(0)) == ToolWay::State::kGoing);
  CHECK(way.goal().position.x() == doctest::Approx(0.1));
  CHECK(way.advance(at(0.08)) == ToolWay::State::kGoing);  // 3 cm are near enough to pass
  CHECK(way.goal().position.x() == doctest::Approx(0.2));
  CHECK(way.advance(at(0.195)) == ToolWay::State::kGoing);
  CHECK(way.is_last());
  CHECK(way.advance(at(0.299)) == ToolWay::State::kThere);

  way.begin({at(0.3)}, 0.004, 0.010);
  CHECK(way.advance(at(0.1)) == ToolWay::State::kGoing);
  for (int i = 0; i < 2; ++i) CHECK(way.advance(at(0.1)) == ToolWay::State::kGoing);
  CHECK(way.advance(at(0.1)) == ToolWay::State::kStuck);
}

}  // namespace probe::expert
