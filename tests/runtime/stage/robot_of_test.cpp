// A plan's robot as data, its hand by its shapes, and what is measured of it and of fixtures.
#include "runtime/stage/robot_of.h"

#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "runtime/robot/hands.h"
#include "runtime/scene/hull.h"
#include "runtime/stage/hand_of_shapes.h"
#include "runtime/stage/measure.h"
#include "runtime/stage/privileged.h"
#include "tests/parity/published.h"
#include "tests/runtime/robot/made_urdf.h"

namespace probe::stage {
namespace {

using robot::test::drawer_text;
using robot::test::link_text;
using robot::test::load_text;

constexpr const char* kTask = "carrot_on_plate";

// A task of the suite with its assets.
struct Set {
  const plan::Plan& plan = test::suite_plan();
  const plan::TaskRecord& task = plan.tasks()[plan.find_task(kTask).value()];
  const plan::SceneRecord& scene = plan.scenes()[task.scene];
  const plan::RobotRecord& record = plan.robots()[scene.robot];
  std::shared_ptr<const SharedAssets> assets;
  const UrdfParts* parts = nullptr;

  Set() {
    const std::uint32_t tasks[] = {plan.find_task(kTask).value()};
    auto loaded = SharedAssets::load(plan, VLAPROBE_SOURCE_DIR "/assets", tasks);
    REQUIRE_MESSAGE(loaded.ok(), (loaded.ok() ? "" : to_text(loaded.failure())));
    assets = *loaded;
    parts = assets->robot(record.urdf);
    REQUIRE(parts != nullptr);
  }
};

TEST_CASE("the plan's robot has the joints, fingers and gripper that its text names") {
  const Set set;
  const auto robot = robot_of(set.plan, set.record, *set.parts);
  REQUIRE_MESSAGE(robot.ok(), (robot.ok() ? "" : to_text(robot.failure())));
  CHECK(robot->name == "widowx");
  CHECK(robot->tcp_link == "ee_gripper_link");
  CHECK(robot->control.arm_joints == std::vector<std::string>{"waist", "shoulder", "elbow",
                                                              "forearm_roll", "wrist_angle",
                                                              "wrist_rotate"});
  CHECK(robot->control.finger_joints == std::vector<std::string>{"left_finger", "right_finger"});
  CHECK(robot->joints.size() == 8);
  REQUIRE(robot->fingers.size() == 2);
  CHECK(robot->fingers[0].link == "left_finger_link");
  CHECK(robot->fingers[0].joint == "left_finger");
  CHECK((robot->fingers[0].opens - Vec3(0, 1, 0)).norm() < 1e-12);
  CHECK((robot->fingers[1].opens - Vec3(0, -1, 0)).norm() < 1e-12);
  CHECK(robot->hand.has_value());
}

TEST_CASE("the hand that was measured once is the one that its shapes show") {
  const Set set;
  auto robot = robot_of(set.plan, set.record, *set.parts);
  REQUIRE(robot.ok());
  const auto shown = hand_of_shapes(*robot, *set.parts);
  const auto known = robot::known_hand("wx250s");
  REQUIRE(shown.has_value());
  REQUIRE(known.has_value());
  CHECK(shown->approach.angularDistance(known->approach) < 1e-9);
  const robot::HandShape &a = shown->shape, &b = known->shape;
  CHECK(std::abs(a.tip_below - b.tip_below) < 1e-3);
  CHECK(std::abs(a.palm_above - b.palm_above) < 1e-3);
  CHECK(std::abs(a.finger_half - b.finger_half) < 1e-3);
  CHECK(std::abs(a.outside_half - b.outside_half) < 1e-3);
  CHECK(std::abs(a.palm_half - b.palm_half) < 1e-3);
  CHECK(std::abs(a.palm_front - b.palm_front) < 2e-3);
  // The row is careful by 1.5 mm where fingers meet things, and 3.5 mm short behind the palm.
  CHECK(a.opening_half >= b.opening_half);
  CHECK(a.opening_half < b.opening_half + 1.5e-3);
  CHECK(a.thinnest <= b.thinnest);
  CHECK(a.thinnest > b.thinnest - 1.5e-3);
  CHECK(std::abs(a.palm_back - b.palm_back) < 4e-3);
}

// Gaps between the fingertips' collision meshes at positions of the released joints, m.
TEST_CASE("fingers that turn are measured where they are at each opening") {
  const plan::Plan plan = test::compile_suite("google.probe");
  const std::uint32_t tasks[] = {plan.find_task("pick_standing").value()};
  const auto assets = SharedAssets::load(plan, VLAPROBE_SOURCE_DIR "/assets", tasks);
  REQUIRE(assets.ok());
  const plan::RobotRecord& record =
      plan.robots()[plan.scenes()[plan.tasks()[tasks[0]].scene].robot];
  const auto robot = robot_of(plan, record, *(*assets)->robot(record.urdf));
  REQUIRE_MESSAGE(robot.ok(), (robot.ok() ? "" : to_text(robot.failure())));
  REQUIRE(robot->hand.has_value());
  const robot::HandShape& hand = robot->hand->shape;
  REQUIRE(!hand.turning.empty());
  struct Gap {
    double q, wide;
  };
  for (const Gap& gap : {Gap{0.4, 0.108}, Gap{0.8, 0.055}, Gap{1.0, 0.014}}) {
    const double openness = 1 - gap.q / 1.3001;
    CHECK(2 * hand.gap_at(openness) == doctest::Approx(gap.wide).epsilon(0.1));
    CHECK(hand.openness_for(0.5 * gap.wide) == doctest::Approx(openness).epsilon(0.05));
  }
  CHECK(hand.gap_at(0) == 0);  // closed empty they meet before their limits
  for (std::size_t i = 1; i < hand.turning.size(); ++i)
    CHECK(hand.turning[i].gap_half > hand.turning[i - 1].gap_half);
  // Palm and tips are where the tool centre point's link says: it is between the tips.
  CHECK(hand.tip_below > 0);
  CHECK(hand.tip_below < 0.02);
  CHECK(hand.palm_above > 0.05);
}

TEST_CASE("a robot without fingers has an arm and no hand") {
  const Set set;
  plan::RobotRecord bare = set.record;
  bare.fingers = {};
  const auto robot = robot_of(set.plan, bare, *set.parts);
  REQUIRE(robot.ok());
  CHECK(robot->fingers.empty());
  CHECK(robot->control.finger_joints.empty());
  CHECK(robot->control.arm_joints.size() == 8);
  CHECK(!robot->hand.has_value());
  CHECK(!hand_of_shapes(*robot, *set.parts).has_value());
}

TEST_CASE("drives that the controller cannot take in their order are refused") {
  const Set set;
  plan::RobotRecord one = set.record;
  one.fingers = {set.record.fingers[0], {}};  // the right finger's drive then follows the left's
  const auto robot = robot_of(set.plan, one, *set.parts);
  REQUIRE(!robot.ok());
  CHECK(robot.failure().code == Fault::kPlan);
  CHECK(robot.failure().where == "robot `widowx`");
}

TEST_CASE("a finger that the URDF lacks is refused by name") {
  const Set set;
  plan::RobotRecord other = set.record;
  other.fingers[1].link = set.task.name;
  const auto robot = robot_of(set.plan, other, *set.parts);
  REQUIRE(!robot.ok());
  CHECK(robot.failure().code == Fault::kUrdf);
  CHECK(robot.failure().message == "no link `carrot_on_plate`");
}

// A palm of 20 x 4 x 6 cm under z, and two fingers 1 cm thick, 2 cm wide and 4 cm long on it that
// part along y by up to 4 cm each; the tool 1 cm above the tips.
TEST_CASE("a hand that points along its z is measured in a frame whose x points there") {
  const std::string joint =
      "<origin xyz='0 0 0.06'/><limit lower='0' upper='0.04' effort='1' velocity='1'/></joint>";
  const robot::RobotModel model = load_text(
      "<robot name='grabber'><link name='palm'/>" + link_text("left", 2) + link_text("right", 2) +
      "<link name='tool'/><joint name='left_slide' type='prismatic'><parent link='palm'/><child "
      "link='left'/><axis xyz='0 1 0'/>" +
      joint +
      "<joint name='right_slide' type='prismatic'><parent link='palm'/><child link='right'/><axis "
      "xyz='0 -1 0'/>" +
      joint +
      "<joint name='fix' type='fixed'><parent link='palm'/><child link='tool'/><origin xyz='0 0 "
      "0.09'/></joint></robot>");
  UrdfParts parts;
  parts.model = model;
  parts.shapes.resize(model.links.size());
  const auto put = [&](const char* link, const Vec3& half, const Vec3& at) {
    parts.shapes[static_cast<std::size_t>(model.find_link(link))] =
        std::make_shared<scene::CollisionShape>(
            scene::join_shapes({{scene::make_box_shape(half), {at, Quat::Identity()}}}));
  };
  put("palm", {0.02, 0.1, 0.03}, {0, 0, 0.03});
  put("left", {0.01, 0.005, 0.02}, {0, 0.005, 0.02});
  put("right", {0.01, 0.005, 0.02}, {0, -0.005, 0.02});
  robot::Robot robot;
  robot.name = model.name;
  robot.model = &parts.model;
  robot.tcp_link = "tool";
  robot.joints = robot.control.finger_joints = {"left_slide", "right_slide"};
  robot.control.grip_closed = 0.001;
  robot.control.grip_open = 0.04;
  robot.fingers = {{"left", "left_slide", Vec3::UnitY()}, {"right", "right_slide", -Vec3::UnitY()}};
  const auto hand = hand_of_shapes(robot, parts);
  REQUIRE(hand.has_value());
  CHECK((hand->approach * Vec3::UnitX() - Vec3::UnitZ()).norm() < 1e-12);
  CHECK((hand->approach * Vec3::UnitY() - Vec3::UnitY()).norm() < 1e-12);
  const auto near = [](double m) { return doctest::Approx(m).epsilon(1e-9); };
  CHECK(hand->shape.tip_below == near(0.01));
  CHECK(hand->shape.opening_half == near(0.04));
  CHECK(hand->shape.outside_half == near(0.05));
  CHECK(hand->shape.finger_half == near(0.01));
  CHECK(hand->shape.palm_above == near(0.03));
  CHECK(hand->shape.palm_half == near(0.1));
  CHECK(hand->shape.palm_back == near(0.02));
  CHECK(hand->shape.palm_front == near(0.02));
  CHECK(hand->shape.thinnest == near(0.0025));

  robot.fingers[1].opens = Vec3::UnitY();  // two that open one way hold nothing
  CHECK(!hand_of_shapes(robot, parts).has_value());
  robot.fingers.push_back(robot.fingers[0]);
  CHECK(!hand_of_shapes(robot, parts).has_value());
}

TEST_CASE("of three fingers each is seen to touch by itself, and what presses nothing does not") {
  TaskBodies bodies;
  bodies.names.resize(7);
  bodies.objects = 2;
  bodies.surface = 2;
  bodies.first_link = 3;
  bodies.robot_links = 4;
  bodies.links = {{0, 4}, {0, 5}, {0, 6}, {0, 7}};  // three fingers and the palm
  vm::StepSample sample;
  sample.bodies.resize(7);
  const Vec3 push(0, 0.01, 0);
  sample.contacts = {{0, 3, push}, {0, 4, Vec3(0, 1e-9, 0)},
                     {0, 5, push}, {0, 6, push},
                     {1, 2, push}, {1, 4, push},
                     {2, 5, push}};
  policy::Privileged view;
  view.objects.resize(2);
  update_privileged(sample, bodies, 3, &view);
  CHECK(view.objects[0].finger_contact == std::vector<bool>{true, false, true});
  CHECK(view.objects[1].finger_contact == std::vector<bool>{false, true, false});
  update_privileged(sample, bodies, 0, &view);
  CHECK(view.objects[0].finger_contact.empty());
}

TEST_CASE("the sample has the joints of fixtures after those of the robot") {
  const Set set;
  const auto robot = robot_of(set.plan, set.record, *set.parts);
  REQUIRE(robot.ok());
  const auto bodies = task_bodies(set.plan, set.task, *set.assets);
  REQUIRE(bodies.ok());
  auto trees = placed_trees(set.plan, set.task, *set.assets);
  REQUIRE(trees.ok());

  world::WorldSpec spec;
  world::ArticulationSpec arm;
  arm.model = &set.parts->model;
  arm.base = base_pose(set.scene);
  for (const plan::DriveRecord& drive : set.plan.drives(set.record)) {
    arm.joints.push_back(
        {std::string(set.plan.text(drive.joint)), drive.stiffness, drive.damping, drive.limit});
  }
  const auto start = set.plan.joints(set.scene);
  arm.positions.assign(start.begin(), start.end());
  const robot::RobotModel cabinet = load_text(drawer_text());
  world::ArticulationSpec fixture;
  fixture.model = &cabinet;
  fixture.base = {Vec3(2, 0, 1), Quat(1, 0, -1, 0).normalized()};  // it slides down
  fixture.joints = {{.joint = "slide"}};
  fixture.positions = {0.1};
  fixture.driven = false;
  spec.articulations = {arm, fixture};
  for (std::size_t i = 0; i < bodies->objects; ++i) {
    const plan::ObjectRecord& object = set.plan.objects()[set.plan.bodies(set.task)[i].index];
    spec.bodies.push_back({"thing",
                           set.assets->shape(object.collision),
                           object.density,
                           object.friction,
                           {Vec3(5.0 + double(i), 5, 1), Quat::Identity()}});
  }
  auto world = world::World::create(spec);
  REQUIRE_MESSAGE(world.ok(), (world.ok() ? "" : to_text(world.failure())));
  REQUIRE(world->get()->step(20).ok());

  Instruments instruments(set.plan, set.task, *bodies, std::move(*trees),
                          set.parts->model.find_link(robot->tcp_link));
  vm::StepSample sample;
  instruments.read(**world, 1, 20, 1, &sample);
  REQUIRE(sample.joints.size() == 9);
  for (std::size_t i = 0; i < 8; ++i) {
    CHECK(sample.joints[i].position == world->get()->joints()[i]);
  }
  const vm::JointSample& slide = sample.joints[8];
  CHECK(slide.position == world->get()->joints()[8]);
  CHECK(slide.rate == world->get()->joint_speeds()[8]);
  CHECK(slide.rate == doctest::Approx(-9.81 * 0.04).epsilon(0.01));  // m/s, after 0.04 s
  CHECK(slide.position == doctest::Approx(0.1 - 0.5 * 9.81 * 0.04 * 0.042).epsilon(0.001));  // m
}

}  // namespace
}  // namespace probe::stage
