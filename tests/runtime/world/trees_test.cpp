// Robots of other kinds: an arm with geared fingers, a mobile manipulator with turning fingers.
// They load, move to targets, stop at limits and hold a box.
#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>

#include "runtime/base/trig.h"
#include "runtime/robot/ik.h"
#include "runtime/robot/kinematics.h"
#include "runtime/scene/hull.h"
#include "runtime/world/joint_tree.h"
#include "runtime/world/world.h"
#include "tests/runtime/robot/made_urdf.h"

namespace probe::world {
namespace {

constexpr double kHalfPi = 1.5707963267948966;

// A link of a rod's inertia, a joint above it.
std::string link(const std::string& name, double mass = 1.0) {
  const std::string i = std::to_string(0.01 * mass);
  return "<link name='" + name + "'><inertial><origin xyz='0.01 0.02 0.03' rpy='0.1 0 0.2'/>" +
         "<mass value='" + std::to_string(mass) + "'/><inertia ixx='" + i + "' iyy='" + i +
         "' izz='" + i + "' ixy='" + std::to_string(0.002 * mass) +
         "' ixz='0' iyz='0'/></inertial></link>\n";
}
std::string joint(const std::string& name, const std::string& type, const std::string& parent,
                  const std::string& child, const std::string& origin, const std::string& axis,
                  const std::string& more = "") {
  return "<joint name='" + name + "' type='" + type + "'><parent link='" + parent +
         "'/><child link='" + child + "'/><origin " + origin + "/><axis xyz='" + axis + "'/>" +
         more + "</joint>\n";
}
std::string limits(double lower, double upper) {
  return "<limit lower='" + std::to_string(lower) + "' upper='" + std::to_string(upper) +
         "' effort='87' velocity='2'/>";
}

// Seven turning joints in a zigzag and two fingers of which one follows the other.
std::string geared_arm() {
  std::string text = "<robot name='geared'>" + link("link0", 3);
  const char* origins[] = {"xyz='0 0 0.333'",
                           "rpy='-1.5707963267948966 0 0'",
                           "xyz='0 -0.316 0' rpy='1.5707963267948966 0 0'",
                           "xyz='0.0825 0 0' rpy='1.5707963267948966 0 0'",
                           "xyz='-0.0825 0.384 0' rpy='-1.5707963267948966 0 0'",
                           "rpy='1.5707963267948966 0 0'",
                           "xyz='0.088 0 0' rpy='1.5707963267948966 0 0'"};
  for (int i = 0; i < 7; ++i) {
    const std::string n = std::to_string(i + 1);
    text += link("link" + n, 2.5 - 0.2 * i);
    text += joint("joint" + n, "revolute", "link" + std::to_string(i), "link" + n, origins[i],
                  "0 0 1", limits(i == 3 ? -3.07 : -2.9, i == 3 ? -0.07 : (i == 5 ? 3.75 : 2.9)));
  }
  text += link("hand", 0.7) + link("finger1", 0.015) + link("finger2", 0.015) + link("tip", 0.001);
  text +=
      joint("hand_joint", "fixed", "link7", "hand", "xyz='0 0 0.107' rpy='0 0 -0.785398'", "0 0 1");
  text +=
      joint("slide1", "prismatic", "hand", "finger1", "xyz='0 0 0.0584'", "0 1 0", limits(0, 0.04));
  text += joint("slide2", "prismatic", "hand", "finger2", "xyz='0 0 0.0584'", "0 -1 0",
                limits(0, 0.04) + "<mimic joint='slide1'/>");
  text += joint("tip_joint", "fixed", "hand", "tip", "xyz='0 0 0.1034'", "0 0 1");
  return text + "</robot>";
}

// A base that stands, a lift, six arm joints of which two turn without end, a head, two fingers
// that turn.
std::string mobile_arm() {
  std::string text = "<robot name='mobile'>";
  for (const char* name : {"wheels", "base", "torso", "shoulder", "bicep", "forearm", "roll",
                           "wrist", "gripper", "neck", "head", "tip"}) {
    text += link(name, 1);
  }
  text += link("finger_left", 0.05) + link("finger_right", 0.05);
  text += joint("stand", "fixed", "wheels", "base", "xyz='0 0 0.2'", "1 0 0");
  text += joint("lift", "prismatic", "base", "torso", "xyz='0 0 0.3'", "0 0 1", limits(0, 0.4));
  text += joint("shoulder_yaw", "continuous", "torso", "shoulder", "xyz='0.1 0 0.2'", "0 0 1");
  text += joint("shoulder_pitch", "revolute", "shoulder", "bicep", "xyz='0 0 0.05'", "0 1 0",
                limits(-1.6, 1.6));
  text +=
      joint("elbow", "revolute", "bicep", "forearm", "xyz='0.35 0 0'", "0 1 0", limits(-0.2, 2.8));
  text += joint("forearm_roll", "continuous", "forearm", "roll", "xyz='0.1 0 0'", "1 0 0");
  text +=
      joint("wrist_pitch", "revolute", "roll", "wrist", "xyz='0.2 0 0'", "0 1 0", limits(-2, 2));
  text += joint("gripper_roll", "continuous", "wrist", "gripper", "xyz='0.1 0 0'", "1 0 0");
  text += joint("hinge_left", "revolute", "gripper", "finger_left", "xyz='0.02 0.04 0'", "0 0 -1",
                limits(0, 1.3));
  text += joint("hinge_right", "revolute", "gripper", "finger_right", "xyz='0.02 -0.04 0'", "0 0 1",
                limits(0, 1.3));
  text += joint("tip_joint", "fixed", "gripper", "tip", "xyz='0.12 0 0'", "1 0 0");
  text += joint("pan", "revolute", "torso", "neck", "xyz='0 0 0.4'", "0 0 1", limits(-2, 2));
  text += joint("tilt", "revolute", "neck", "head", "xyz='0 0 0.1'", "0 1 0", limits(-1, 1));
  return text + "</robot>";
}

using robot::test::load_text;

std::shared_ptr<const scene::CollisionShape> box(const Vec3& low, const Vec3& high) {
  std::vector<Vec3> points;
  for (int i = 0; i < 8; ++i) {
    points.emplace_back(i & 1 ? high.x() : low.x(), i & 2 ? high.y() : low.y(),
                        i & 4 ? high.z() : low.z());
  }
  auto shape = scene::make_collision_shape({points}, "box");
  REQUIRE(shape.ok());
  return std::make_shared<scene::CollisionShape>(std::move(shape).value());
}

// Drives by name; the drives' order is the order of q.
struct Robot {
  robot::RobotModel model;
  WorldSpec spec;
  std::vector<std::string> arm_joints;
  std::size_t arm = 0;
};

Robot geared() {
  Robot r{load_text(geared_arm()), {}, {}, 7};
  ArticulationSpec& arm = r.spec.articulations.emplace_back();
  for (int i = 1; i <= 7; ++i) {
    arm.joints.push_back({"joint" + std::to_string(i), 1000, 100, 100});
    r.arm_joints.push_back(arm.joints.back().joint);
  }
  arm.joints.push_back({"slide1", 1000, 100, 40});
  arm.positions = {0, -0.785398, 0, -2.356194, 0, kHalfPi, 0.785398, 0.04};
  arm.links = {{"hand", box({-0.02, -0.1, -0.02}, {0.02, 0.1, 0.06}), 1.0, 0},
               {"finger1", box({-0.009, 0, 0.02}, {0.009, 0.012, 0.0535}), 2.0, 0.01},
               {"finger2", box({-0.009, -0.012, 0.02}, {0.009, 0, 0.0535}), 2.0, 0.01}};
  return r;
}

Robot mobile() {
  Robot r{load_text(mobile_arm()), {}, {}, 7};
  ArticulationSpec& arm = r.spec.articulations.emplace_back();
  for (const char* name : {"lift", "shoulder_yaw", "shoulder_pitch", "elbow", "forearm_roll",
                           "wrist_pitch", "gripper_roll"}) {
    arm.joints.push_back({name, 1500, 200, 300});
    r.arm_joints.push_back(name);
  }
  arm.joints.push_back({"pan", 100, 10, 10});
  arm.joints.push_back({"tilt", 100, 10, 10});
  arm.joints.push_back({"hinge_left", 50, 2, 10});
  arm.joints.push_back({"hinge_right", 50, 2, 10});
  arm.positions = {0.2, 0, 0.3, 0.5, 0, kHalfPi - 0.8, 0, 0, 0, 0, 0};
  const auto finger = box({0, -0.005, -0.012}, {0.1, 0.005, 0.012});
  arm.links = {{"base", box({-0.3, -0.3, -0.2}, {0.1, 0.3, 0.2}), 1.0, 0},
               {"gripper", box({-0.05, -0.05, -0.03}, {0.01, 0.05, 0.03}), 1.0, 0},
               {"finger_left", finger, 2.0, 0.01},
               {"finger_right", finger, 2.0, 0.01}};
  return r;
}

std::unique_ptr<World> make(Robot* r) {
  r->spec.articulations[0].model = &r->model;
  auto world = World::create(r->spec);
  REQUIRE_MESSAGE(world.ok(), (world.ok() ? "" : to_text(world.failure())));
  return std::move(world).value();
}

void run(World* world, int substeps) {
  const Status status = world->step(substeps);
  REQUIRE_MESSAGE(status.ok(), (status.ok() ? "" : to_text(status.failure())));
}

std::vector<double> state(const World& world) {
  return {world.joints().begin(), world.joints().end()};
}

// Joint positions that put the link `tip` there with its present orientation.
std::vector<double> reach(const Robot& r, const std::vector<double>& from, const Vec3& place) {
  auto chain = robot::Chain::create(r.model, "tip", r.arm_joints);
  REQUIRE(chain.ok());
  std::vector<double> q = from;
  const std::span<double> arm = std::span(q).first(r.arm);
  const Pose now = chain->pose(arm);
  const auto found = robot::solve_ik(*chain, {place, now.rotation}, arm);
  REQUIRE(found.converged);
  return q;
}

Vec3 tip(const World& world) { return world.frame_pose("tip").position; }

// Positions a link of the tree, as the multibody library wants them.
std::vector<double> per_link(const JointTree& tree, const JointArray& q) {
  std::vector<double> out;
  for (const JointTree::Follower& motion : tree.motions()) {
    out.push_back(motion.scale * q[static_cast<std::size_t>(motion.leader)] + motion.offset);
  }
  return out;
}

struct TreePair {
  std::unique_ptr<JointTree> ours;
  std::unique_ptr<Multibody> library;
};

TreePair make_trees(const Robot& r, const Pose& base) {
  std::vector<int> order;
  for (const JointSpec& j : r.spec.articulations[0].joints) {
    order.push_back(r.model.find_joint(j.joint));
  }
  auto ours = JointTree::create(r.model, base, order);
  REQUIRE_MESSAGE(ours.ok(), (ours.ok() ? "" : to_text(ours.failure())));
  auto library = Multibody::create(r.model.name, (*ours)->tree(), (*ours)->outward());
  REQUIRE(library.ok());
  return {std::move(*ours), std::move(*library)};
}

const Pose kTilted{{0.3, -0.2, 0.1}, Quat(0.8, 0, 0.6, 0)};

TEST_CASE("the mass matrix is the multibody library's own, geared fingers included") {
  for (const bool is_geared : {true, false}) {
    Robot r = is_geared ? geared() : mobile();
    const TreePair trees = make_trees(r, kTilted);
    const auto n = static_cast<std::size_t>(trees.ours->count());
    JointArray q{};
    for (std::size_t i = 0; i < n; ++i) q[i] = r.spec.articulations[0].positions[i] + 0.1;
    trees.ours->update(q);
    const auto placed = trees.library->place(per_link(*trees.ours, q));
    REQUIRE(placed.ok());
    // The library has a speed a link; those of followers go to their leaders.
    JointMatrix library{};
    const auto& motions = trees.ours->motions();
    for (std::size_t a = 0; a < motions.size(); ++a) {
      for (std::size_t b = 0; b < motions.size(); ++b) {
        library[static_cast<std::size_t>(motions[a].leader)]
               [static_cast<std::size_t>(motions[b].leader)] +=
            motions[a].scale * motions[b].scale * placed->mass[a][b];
      }
    }
    double worst = 0, largest = 0;
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < n; ++j) {
        worst = std::max(worst, std::fabs(trees.ours->mass()[i][j] - library[i][j]));
        largest = std::max(largest, std::fabs(library[i][j]));
      }
    }
    CHECK(largest > 0.1);
    CHECK(worst < 1e-12 * largest);
    CHECK(trees.ours->followers().size() == (is_geared ? 1 : 0));
  }
}

TEST_CASE("links stand where the multibody library puts them, bit for bit") {
  std::size_t different = 0, compared = 0;
  double worst = 0;
  std::uint64_t draw = 7;
  const auto uniform = [&] {
    draw = draw * 6364136223846793005ull + 1442695040888963407ull;
    return static_cast<double>(draw >> 11) * 0x1.0p-53;
  };
  const auto compare = [&](double ours, double library) {
    ++compared;
    different += ours != library;
    worst = std::max(worst, std::fabs(ours - library));
  };
  for (const bool is_geared : {true, false}) {
    for (const Pose& base : {Pose{}, kTilted}) {
      Robot r = is_geared ? geared() : mobile();
      const TreePair trees = make_trees(r, base);
      for (int trial = 0; trial < 300; ++trial) {
        JointArray q{};
        for (int i = 0; i < trees.ours->count(); ++i) {
          q[static_cast<std::size_t>(i)] = 6 * uniform() - 3;
        }
        trees.ours->update(q);
        const auto placed = trees.library->place(per_link(*trees.ours, q));
        REQUIRE(placed.ok());
        for (std::size_t k = 0; k < trees.ours->link_count(); ++k) {
          const MovingLink& link = trees.ours->link(static_cast<int>(k));
          for (int i = 0; i < 3; ++i) {
            compare(link.origin[i], placed->origins[k][i]);
            for (int j = 0; j < 3; ++j) compare(link.axes(i, j), placed->axes[k](i, j));
          }
        }
      }
    }
  }
  MESSAGE(compared, " numbers, ", different, " different, worst ", worst);
  CHECK(compared > 100000);
  CHECK(worst < 1e-14);
  // Another build of the library may round otherwise; Debian's does not.
  if (multibody_build().library_asserts) CHECK(different == 0);
}

TEST_CASE("links stand where kinematics says, followers too") {
  Robot r = geared();
  const auto world = make(&r);
  std::vector<std::string> names;
  for (const JointSpec& d : r.spec.articulations[0].joints) names.push_back(d.joint);
  auto tree = robot::Tree::create(r.model, names);
  REQUIRE(tree.ok());
  std::vector<double> q = state(*world);
  for (std::size_t i = 0; i < 7; ++i) q[i] += 0.1 * static_cast<double>(i % 3);
  q[7] = 0.013;
  world->set_joints(q);
  std::vector<Pose> poses(r.model.links.size());
  tree->link_poses(q, poses);
  for (const char* name : {"link4", "hand", "finger1", "finger2", "tip"}) {
    const Pose expected = poses[static_cast<std::size_t>(r.model.find_link(name))];
    CHECK((world->frame_pose(name).position - expected.position).norm() < 1e-12);
  }
}

TEST_CASE("robots of either kind go to their targets and stop at both limits of every joint") {
  for (const bool is_geared : {true, false}) {
    Robot r = is_geared ? geared() : mobile();
    r.spec.surface_z = -5;
    const auto world = make(&r);
    std::vector<double> target = state(*world);
    for (std::size_t i = 0; i < r.arm; ++i) target[i] += i % 2 ? 0.1 : -0.1;
    world->set_targets(target);
    run(world.get(), 2000);
    for (std::size_t i = 0; i < r.arm; ++i) {
      CHECK(std::fabs(world->joints()[i] - target[i]) < 1e-3);
    }
    const std::vector<double> home = r.spec.articulations[0].positions;
    for (std::size_t i = 0; i < home.size(); ++i) {
      const JointSpec& drive = r.spec.articulations[0].joints[i];
      const robot::Joint& joint =
          r.model.joints[static_cast<std::size_t>(r.model.find_joint(drive.joint))];
      for (const double side : {-1.0, 1.0}) {
        world->set_joints(home);
        target = home;
        target[i] += side * 8;
        world->set_targets(target);
        double farthest = 0;  // past the limit
        for (int k = 0; k < 30; ++k) {
          run(world.get(), 100);
          farthest = std::max(
              {farthest, world->joints()[i] - joint.upper, joint.lower - world->joints()[i]});
        }
        if (joint.kind == robot::JointKind::kContinuous) {
          CHECK(std::fabs(world->joints()[i] - target[i]) < 1.0);
          continue;
        }
        const double limit = side < 0 ? joint.lower : joint.upper;
        CHECK_MESSAGE(std::fabs(world->joints()[i] - limit) < 1e-3, drive.joint, " ", side);
        CHECK_MESSAGE(farthest < 1e-3, drive.joint, " ", side, " passes its limit by ", farthest);
      }
    }
  }
}

TEST_CASE("robots of either kind hold a box and carry it up without slip") {
  for (const bool is_geared : {true, false}) {
    Robot r = is_geared ? geared() : mobile();
    const double half = is_geared ? 0.02 : 0.025;
    r.spec.surface_z = is_geared ? 0.0 : 0.3;
    r.spec.sleeping = false;
    {
      const auto bare = make(&r);
      Vec3 spot = tip(*bare);
      spot.z() = r.spec.surface_z + half;
      r.spec.articulations[0].positions =
          reach(r, state(*bare), spot + Vec3(0, 0, is_geared ? 0.0 : 0.005));
      r.spec.bodies.push_back(
          {"box",
           std::make_shared<scene::CollisionShape>(scene::make_box_shape(Vec3::Constant(half))),
           500, 0.5, Pose{spot, Quat::Identity()}});
    }
    const auto world = make(&r);
    std::vector<double> target = state(*world);
    for (std::size_t i = is_geared ? 7 : 9; i < target.size(); ++i) target[i] = is_geared ? 0 : 0.2;
    world->set_targets(target);
    run(world.get(), 300);
    const Vec3 start = tip(*world);
    for (int k = 1; k <= 5; ++k) {
      const std::vector<double> q = reach(r, state(*world), start + Vec3(0, 0, 0.03 * k));
      std::copy_n(q.begin(), r.arm, target.begin());
      world->set_targets(target);
      run(world.get(), 150);
    }
    run(world.get(), 500);
    const auto held = [&] { return (world->frame_pose("tip").inverse() * world->body(0).pose); };
    const Pose before = held();
    CHECK(world->body(0).pose.position.z() > r.spec.surface_z + half + 0.1);
    double slip = 0;
    for (int k = 0; k < 20; ++k) {
      run(world.get(), 100);
      slip = std::max(slip, (held().position - before.position).norm());
    }
    MESSAGE(r.model.name, ": slip ", slip * 1e3, " mm in 4 s");
    CHECK(slip < 1e-6);
    if (is_geared) {
      const Vec3 a = world->frame_pose("finger1").position, b = world->frame_pose("tip").position,
                 c = world->frame_pose("finger2").position;
      const Mat3 axes = world->frame_pose("hand").rotation.toRotationMatrix();
      CHECK(std::fabs(axes.col(1).dot(a - b) + axes.col(1).dot(c - b)) < 1e-12);
    }
  }
}

TEST_CASE("turning fingers that press with their full force hold a box without creep") {
  for (const double beyond : {1.0, 1.3}) {
    Robot r = mobile();
    const double half = 0.025;
    r.spec.surface_z = 0.3;
    r.spec.sleeping = false;
    {
      const auto bare = make(&r);
      Vec3 spot = tip(*bare);
      spot.z() = r.spec.surface_z + half;
      r.spec.articulations[0].positions = reach(r, state(*bare), spot + Vec3(0, 0, 0.005));
      r.spec.bodies.push_back(
          {"box",
           std::make_shared<scene::CollisionShape>(scene::make_box_shape(Vec3::Constant(half))),
           500, 0.5, Pose{spot, Quat::Identity()}});
    }
    const auto world = make(&r);
    std::vector<double> target = state(*world);
    target[9] = target[10] = beyond;
    world->set_targets(target);
    run(world.get(), 300);
    const Vec3 start = tip(*world);
    for (int k = 1; k <= 5; ++k) {
      const std::vector<double> q = reach(r, state(*world), start + Vec3(0, 0, 0.03 * k));
      std::copy_n(q.begin(), r.arm, target.begin());
      world->set_targets(target);
      run(world.get(), 150);
    }
    run(world.get(), 500);
    CHECK(world->body(0).pose.position.z() > r.spec.surface_z + half + 0.1);
    CHECK(world->drive_load() == doctest::Approx(1).epsilon(2e-3));
    const auto held = [&] { return world->frame_pose("tip").inverse() * world->body(0).pose; };
    const Vec3 before = held().position;
    run(world.get(), 5000);
    const double creep = (held().position - before).norm();
    MESSAGE("targets of ", beyond, " rad: creep ", creep * 1e3, " mm in 10 s");
    CHECK(creep < 1e-6);
  }
}

// How far a box sinks in the hand in 1.2 s where fingers that hold it up press anew from nothing
// three times a second, as their drives' targets then do: from where they are, by 8.3 t^3.
double sinks(double give) {
  Robot r = mobile();
  const double half = 0.025;
  r.spec.surface_z = 0.3;
  r.spec.sleeping = false;
  for (auto& link : r.spec.articulations[0].links) {
    if (link.name.starts_with("finger")) link.give = give;
  }
  {
    const auto bare = make(&r);
    Vec3 spot = tip(*bare);
    spot.z() = r.spec.surface_z + half;
    r.spec.articulations[0].positions = reach(r, state(*bare), spot + Vec3(0, 0, 0.005));
    r.spec.bodies.push_back(
        {"box",
         std::make_shared<scene::CollisionShape>(scene::make_box_shape(Vec3::Constant(half))), 160,
         0.5, Pose{spot, Quat::Identity()}});
  }
  const auto world = make(&r);
  std::vector<double> target = state(*world);
  target[9] = target[10] = 0.2;
  world->set_targets(target);
  run(world.get(), 300);
  const std::vector<double> up = reach(r, state(*world), tip(*world) + Vec3(0, 0, 0.05));
  std::copy_n(up.begin(), r.arm, target.begin());
  world->set_targets(target);
  run(world.get(), 500);
  const auto height = [&] {
    return world->body(0).pose.position.z() - world->frame_pose("tip").position.z();
  };
  const double before = height();
  for (int k = 0; k < 600; ++k) {
    const double t = 0.002 * (k % 167 + 1);
    if (k % 167 == 0) target[9] = world->joints()[9], target[10] = world->joints()[10];
    std::vector<double> now = target;
    for (const std::size_t finger : {9, 10}) now[finger] += 8.3 * t * t * t;
    world->set_targets(now);
    run(world.get(), 1);
  }
  return before - height();
}

TEST_CASE("what sank into fingers that give way is held where they press anew from nothing") {
  const double soft = sinks(1e-6), hard = sinks(0);
  MESSAGE("sinks ", soft * 1e3, " mm in fingers that give way, ", hard * 1e3, " mm in others");
  CHECK(std::fabs(soft) < 2e-4);
  CHECK(hard > 2e-3);
}

TEST_CASE("fingers that give way by a number that is no length a force are refused") {
  for (const double give : {-1e-6, std::nan("")}) {
    Robot r = mobile();
    r.spec.articulations[0].links.back().give = give;
    r.spec.articulations[0].model = &r.model;
    const auto refused = World::create(r.spec);
    REQUIRE(!refused.ok());
    CHECK(to_text(refused.failure()).find("finger_right") != std::string::npos);
  }
}

TEST_CASE("a follower's limits bind its leader, and limits that contradict are refused") {
  std::string text = geared_arm();
  const auto change = [&](const std::string& from, const std::string& to) {
    const auto at = text.find(from);
    REQUIRE(at != std::string::npos);
    text.replace(at, from.size(), to);
  };
  change("<mimic joint='slide1'/>", "<mimic joint='slide1' multiplier='2' offset='-0.01'/>");
  Robot r = geared();
  r.model = load_text(text);
  {
    const auto world = make(&r);
    std::vector<double> target = state(*world);
    for (const double to : {0.0, 0.1}) {
      target[7] = to;
      world->set_targets(target);
      run(world.get(), 1500);
      // 0 <= 2 q - 0.01 <= 0.04.
      CHECK(world->joints()[7] == doctest::Approx(to == 0 ? 0.005 : 0.025).epsilon(0.02));
    }
  }
  change("offset='-0.01'", "offset='0.1'");
  r.model = load_text(text);
  r.spec.articulations[0].model = &r.model;
  const auto refused = World::create(r.spec);
  REQUIRE(!refused.ok());
  CHECK(refused.failure().message.find("`slide2` mimics `slide1`") != std::string::npos);
}

TEST_CASE("more joints than a world has room for are refused") {
  std::string text = "<robot name='snake'>" + link("l0");
  Robot r{{}, {}, {}, 0};
  r.spec.articulations.emplace_back();
  for (int i = 1; i <= kMaxJoints + 1; ++i) {
    const std::string n = std::to_string(i);
    text += link("l" + n) + joint("j" + n, "continuous", "l" + std::to_string(i - 1), "l" + n,
                                  "xyz='0 0 0.1'", i % 2 ? "1 0 0" : "0 1 0");
    r.spec.articulations[0].joints.push_back({"j" + n, 100, 50, 20});
    r.spec.articulations[0].positions.push_back(0);
  }
  r.model = load_text(text + "</robot>");
  r.spec.articulations[0].model = &r.model;
  const auto refused = World::create(r.spec);
  REQUIRE(!refused.ok());
  CHECK(refused.failure().message.find("at most 32") != std::string::npos);
}

}  // namespace
}  // namespace probe::world
