#include "runtime/expert/path_planner.h"

#include "runtime/expert/place_candidates.h"
#include "tests/runtime/expert/fake_table.h"

namespace probe::expert {
namespace {

Reach widowx() {
  auto reach = Reach::create(test::widowx());
  REQUIRE(reach.ok());
  return *std::move(reach);
}

Scene scene_of(const test::FakeTable& table) {
  return look(table.observe(0), {}, *test::widowx().hand);
}

JointVector joints_of(const Scene& scene) {
  return Eigen::Map<const JointVector>(scene.joints.data(), 6);
}

Pose tool_at(const Reach& reach, const JointVector& q) {
  return reach.chain().pose(std::span(q.data(), std::size_t(q.size())));
}

policy::PrivilegedObject tower(const Vec2& at) {
  return test::object("tower", {test::block({-0.02, -0.02, 0}, {0.02, 0.02, 0.12})},
                      {at.x(), at.y(), test::kSurface}, 0);
}

TEST_CASE("the way to the grasp ends there, comes from above and clears what stands between") {
  const Reach reach = widowx();
  const test::FakeTable table(test::carrot(-0.235, -0.075, 20), test::plate(-0.085, 0.075),
                              {tower({-0.19, -0.01})});
  const Scene scene = scene_of(table);
  const auto pick = plan_pick(scene, reach, true);
  REQUIRE(pick.has_value());
  const auto planned = plan_approach(scene, reach, *pick, Recent(3, joints_of(scene)));
  REQUIRE(planned.has_value());
  const Path& path = planned->path;
  const robot::PoseError left =
      robot::pose_error(tool_at(reach, path.at(path.steps())), pick->grasp.tcp);
  CHECK(left.position < 5e-4);
  CHECK(left.rotation < 2e-3);
  const Pose before = tool_at(reach, path.at(path.steps() - 1));
  CHECK((before.position - pick->grasp.tcp.position).head<2>().norm() < 0.002);
  CHECK(before.position.z() > pick->grasp.tcp.position.z() + 0.003);
  CHECK(planned->clearance > -0.001);
  for (int k = 1; k <= path.steps(); ++k) {
    CHECK((path.at(k) - path.at(k - 1)).cwiseAbs().maxCoeff() < 0.4);
  }
}

TEST_CASE("with the source in hand the way rises first and ends over the target") {
  const Reach reach = widowx();
  const test::FakeTable table(test::carrot(-0.235, -0.075, 20), test::plate(-0.085, 0.075));
  Scene scene = scene_of(table);
  const auto pick = plan_pick(scene, reach, true);
  REQUIRE(pick.has_value());
  const auto there = reach.follow(scene.joints, std::array{pick->above, pick->grasp.tcp});
  REQUIRE(there.has_value());
  const JointVector q = there->back();
  scene.joints.assign(q.begin(), q.end());
  const auto place = plan_place(scene, reach, scene.joints);
  REQUIRE(place.has_value());
  int steps[2] = {0, 0};
  for (const bool careful : {false, true}) {
    const auto planned =
        plan_transport(scene, reach, place->tcp, Recent(3, q), careful ? 1.5 : 1.0);
    REQUIRE(planned.has_value());
    const Path& path = planned->path;
    steps[careful] = path.steps();
    const Pose first = tool_at(reach, path.at(1));
    CHECK((first.position - pick->grasp.tcp.position).head<2>().norm() < 0.004);
    CHECK(first.position.z() > pick->grasp.tcp.position.z());
    const Pose last = tool_at(reach, path.at(path.steps()));
    CHECK(robot::pose_error(last, place->tcp).position < 5e-4);
    CHECK(planned->clearance > -0.002);
  }
  CHECK(steps[1] > steps[0]);
}

TEST_CASE("what failed is not tried again while there is something else") {
  const Reach reach = widowx();
  const test::FakeTable table(test::carrot(-0.235, -0.075, 20), test::plate(-0.085, 0.075));
  const Scene scene = scene_of(table);
  const auto first = plan_pick(scene, reach, true);
  REQUIRE(first.has_value());
  const std::array failed{scene.source_pose.inverse() * first->grasp.tcp};
  const auto second = plan_pick(scene, reach, true, failed);
  REQUIRE(second.has_value());
  CHECK((second->grasp.tcp.position - first->grasp.tcp.position).norm() > 0.008);
}

TEST_CASE("a source that leans on the target is taken above it") {
  const Reach reach = widowx();
  policy::PrivilegedObject stick =
      test::object("stick", {test::block({-0.06, -0.01, 0}, {0.06, 0.01, 0.02})},
                   {-0.1, 0.1, test::kSurface + 0.008}, 0);
  stick.pose.rotation = robot::from_rotation_vector({0, 0.12, 0});
  const test::FakeTable table(stick, test::plate(-0.1, 0.1));
  const Scene scene = scene_of(table);
  REQUIRE(scene.source.bottom < scene.target.top);
  const auto pick = plan_pick(scene, reach, true);
  REQUIRE(pick.has_value());
  CHECK(!pick->grasp.rim);
  CHECK(pick->grasp.tcp.position.z() - scene.hand.tip_below > scene.target.top);
}

TEST_CASE("a slim hand's balls lie within it") {
  robot::HandShape slim;
  slim.tip_below = 0.01;
  slim.palm_above = 0.03;
  slim.finger_half = 0.003;
  slim.opening_half = 0.04;
  slim.outside_half = 0.0415;  // fingers of 1.5 mm
  slim.palm_half = 0.05;
  slim.palm_back = slim.palm_front = 0.005;
  for (const Ball& ball : gripper_balls(slim, slim.opening_half)) {
    CHECK(ball.radius >= 0);
    const bool is_palm = ball.center.x() < -slim.palm_above;
    CHECK(std::abs(ball.center.y()) + ball.radius <=
          (is_palm ? slim.palm_half : slim.outside_half) + 1e-12);
    CHECK(std::abs(ball.center.z()) + ball.radius <=
          (is_palm ? slim.palm_back : slim.finger_half) + 1e-12);
  }
}

TEST_CASE("low ways go over what lies near them, others over everything") {
  const auto tower = [](double x, double y) {
    return test::object("tower", {test::block({-0.02, -0.02, 0}, {0.02, 0.02, 0.2})},
                        {x, y, test::kSurface}, 0);
  };
  const test::FakeTable aside(test::carrot(-0.2, 0, 0), test::plate(-0.1, 0.1),
                              {tower(-0.15, 0.45)});
  Scene scene = scene_of(aside);
  const Vec3 from = scene.source_pose.position, to = scene.target_pose.position;
  const double over_all = travel_height(scene, 0.02);
  CHECK(travel_height(scene, 0.02, from, to) == over_all);
  scene.low_ways = true;
  CHECK(travel_height(scene, 0.02, from, to) < over_all - 0.1);
  const test::FakeTable between(test::carrot(-0.2, 0, 0), test::plate(-0.1, 0.1),
                                {tower(-0.15, 0.05)});
  scene = scene_of(between);
  scene.low_ways = true;
  CHECK(travel_height(scene, 0.02, from, to) >= over_all);
}

TEST_CASE("a low way goes to the place, and ends there") {
  const Reach reach = widowx();
  const test::FakeTable table(test::carrot(-0.2, 0, 0), test::plate(-0.1, 0.1));
  Scene scene = scene_of(table);
  scene.low_ways = true;
  const Pose tool = reach.chain().pose(std::span(scene.joints).first(6));
  Pose place = tool;
  place.position += Vec3(0.02, 0.05, -0.05);
  const auto way = way_to_place(scene, reach, scene.joints, 0.02, place);
  REQUIRE(way.has_value());
  REQUIRE(way->size() == 3);
  const Pose end = reach.chain().pose(std::span(way->back().data(), 6));
  CHECK((end.position - place.position).norm() < 1e-4);
}

}  // namespace
}  // namespace probe::expert
