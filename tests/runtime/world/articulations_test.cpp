// Passive articulations: drawers, doors and lids against closed forms, and pulled by the arm.
#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "runtime/scene/hull.h"
#include "runtime/world/stepper.h"
#include "tests/runtime/robot/made_urdf.h"
#include "tests/runtime/world/arm_bench.h"

namespace probe::world {
namespace {

constexpr double kDt = 0.002;

using robot::test::drawer_text;
using robot::test::joint_text;
using robot::test::link_text;
using robot::test::load_text;

// A door of 2 kg, its centre 0.3 m off the hinge along x.
std::string door_text(const std::string& axis) {
  return "<robot name='oven'>" + link_text("frame", 10) + link_text("door", 2, "0.3 0 0") +
         joint_text("hinge", "revolute", "frame", "door", axis, "0 0 0", -2, 2) + "</robot>";
}
constexpr double kDoorInertia = 0.004 + 2 * 0.3 * 0.3;  // kg m2, about the hinge

ArticulationSpec passive(const robot::RobotModel& model, const JointSpec& joint, double q = 0) {
  ArticulationSpec spec;
  spec.model = &model;
  spec.driven = false;
  spec.joints = {joint};
  spec.positions = {q};
  return spec;
}

std::unique_ptr<World> make(const WorldSpec& spec) {
  auto world = World::create(spec);
  REQUIRE_MESSAGE(world.ok(), (world.ok() ? "" : to_text(world.failure())));
  return std::move(world).value();
}

void run(World& world, int substeps) {
  const Status status = world.step(substeps);
  REQUIRE_MESSAGE(status.ok(), (status.ok() ? "" : to_text(status.failure())));
}

std::shared_ptr<const scene::CollisionShape> box(const Vec3& half) {
  return std::make_shared<scene::CollisionShape>(scene::make_box_shape(half));
}

// Pulled along x by an acceleration, in a room without a floor near.
WorldSpec pulled(const ArticulationSpec& articulation, double along_x) {
  WorldSpec spec;
  spec.articulations = {articulation};
  spec.gravity = Vec3(along_x, 0, -9.81);
  spec.surface_z = -5;
  return spec;
}

TEST_CASE("a drawer stays while the pull is below its friction and opens by the book above it") {
  const robot::RobotModel model = load_text(drawer_text());
  const ArticulationSpec drawer = passive(model, {.joint = "slide", .damping = 5, .friction = 3});
  const auto held = make(pulled(drawer, 1.45));  // 2.9 N
  run(*held, 1000);
  CHECK(held->joints()[0] == 0);
  CHECK(held->joint_speeds()[0] == 0);

  // m (u+ - u) = dt (F - friction - damping u+).
  const auto opening = make(pulled(drawer, 2));
  double q = 0, u = 0;
  for (int step = 0; step < 200; ++step) {
    u = (2 * u + kDt * (4 - 3)) / (2 + kDt * 5);
    q += kDt * u;
    run(*opening, 1);
    REQUIRE(opening->joints()[0] == doctest::Approx(q).epsilon(1e-9));
    REQUIRE(opening->joint_speeds()[0] == doctest::Approx(u).epsilon(1e-9));
  }
  CHECK(q > 0.01);
}

TEST_CASE("a drawer that is let go stops after the distance that its friction needs") {
  const robot::RobotModel model = load_text(drawer_text());
  const ArticulationSpec drawer = passive(model, {.joint = "slide", .friction = 3});
  const auto pulled_world = make(pulled(drawer, 4));
  run(*pulled_world, 100);
  const double speed = pulled_world->joint_speeds()[0];
  CHECK(speed > 0.4);
  // The same drawer in a room where nothing pulls.
  const auto free = make(pulled(drawer, 0));
  REQUIRE(free->restore(pulled_world->save()).ok());
  const double from = free->joints()[0];
  run(*free, 1000);
  const double way = free->joints()[0] - from;
  CHECK(way == doctest::Approx(speed * speed * 2 / (2 * 3)).epsilon(0.01));
  CHECK(free->joint_speeds()[0] == 0);
  const double rest = free->joints()[0];
  run(*free, 1000);
  CHECK(free->joints()[0] == rest);
}

TEST_CASE("a drawer under friction and damping stops where the closed form says") {
  const robot::RobotModel model = load_text(drawer_text());
  constexpr double kMass = 2, kFriction = 3, kDamping = 5;  // kg, N, N s/m
  const ArticulationSpec drawer =
      passive(model, {.joint = "slide", .damping = kDamping, .friction = kFriction});
  const auto pulled_world = make(pulled(drawer, 6));
  run(*pulled_world, 100);
  const double speed = pulled_world->joint_speeds()[0];
  CHECK(speed > 0.4);
  const auto free = make(pulled(drawer, 0));
  REQUIRE(free->restore(pulled_world->save()).ok());
  const double from = free->joints()[0];
  run(*free, 1000);
  // m u' = -F - d u.
  const double way = kMass * speed / kDamping - kMass * kFriction / (kDamping * kDamping) *
                                                    std::log(1 + kDamping * speed / kFriction);
  CHECK(free->joints()[0] - from == doctest::Approx(way).epsilon(0.01));
  CHECK(free->joint_speeds()[0] == 0);
}

TEST_CASE("a latched knob stays where it is left, one that is too weak swings back by the book") {
  const robot::RobotModel model = load_text(door_text("0 0 1"));
  constexpr double kSpring = 1, kFriction = 0.4;  // N m/rad, N m
  const auto left_at = [&](double q) {
    const auto world = make(pulled(
        passive(model, {.joint = "hinge", .stiffness = kSpring, .friction = kFriction, .rest = 0.0},
                q),
        0));
    run(*world, 15000);
    CHECK(world->joint_speeds()[0] == 0);
    return world->joints()[0];
  };
  CHECK(left_at(0.39) == 0.39);
  CHECK(left_at(-0.39) == -0.39);
  // Half a swing about where friction and spring balance: it comes to rest within their reach.
  CHECK(left_at(1) == doctest::Approx(2 * kFriction / kSpring - 1).epsilon(0.02));
}

TEST_CASE("a drawer does not pass its ends, however hard it is pulled, and does not bounce") {
  const robot::RobotModel model = load_text(drawer_text());
  for (const double pull : {-40.0, 40.0}) {
    const auto world = make(pulled(passive(model, {.joint = "slide"}, 0.1), pull));
    double least = 1, most = 0;
    for (int i = 0; i < 500; ++i) {
      run(*world, 1);
      least = std::min(least, world->joints()[0]);
      most = std::max(most, world->joints()[0]);
    }
    CHECK(least > -1e-6);
    CHECK(most < 0.2 + 1e-6);
    CHECK(world->joints()[0] == doctest::Approx(pull < 0 ? 0 : 0.2).epsilon(1e-6));
    CHECK(std::fabs(world->joint_speeds()[0]) < 1e-6);
  }
}

TEST_CASE("a door on a spring swings with the period of its inertia and gains no energy") {
  const robot::RobotModel model = load_text(door_text("0 0 1"));
  const double stiffness = 2;
  const auto world =
      make(pulled(passive(model, {.joint = "hinge", .stiffness = stiffness, .armature = 0.05}), 0));
  // Its rest is where it began; it is turned by hand, as a target that comes with the place.
  auto swung = make(pulled(passive(model, {.joint = "hinge", .stiffness = stiffness}), 0));
  const double inertia = kDoorInertia + 0.05;
  // A push: one substep of a pull along y turns it.
  WorldSpec push =
      pulled(passive(model, {.joint = "hinge", .stiffness = stiffness, .armature = 0.05}), 0);
  push.gravity.y() = 50;
  const auto pushed = make(push);
  run(*pushed, 10);
  REQUIRE(world->restore(pushed->save()).ok());
  const auto energy = [&] {
    const double q = world->joints()[0], u = world->joint_speeds()[0];
    return 0.5 * inertia * u * u + 0.5 * stiffness * q * q;
  };
  const double start = energy();
  CHECK(start > 0.05);
  std::vector<double> crossings;
  double most = start;
  for (int i = 0; i < 6000; ++i) {
    const double before = world->joints()[0];
    run(*world, 1);
    const double now = world->joints()[0];
    if (before < 0 && now >= 0) crossings.push_back((i + before / (before - now)) * kDt);
    most = std::max(most, energy());
  }
  REQUIRE(crossings.size() >= 3);
  const double period =
      (crossings.back() - crossings.front()) / static_cast<double>(crossings.size() - 1);
  CHECK(period ==
        doctest::Approx(2 * std::numbers::pi * std::sqrt(inertia / stiffness)).epsilon(1e-3));
  CHECK(most <= start * (1 + 1e-9));
}

TEST_CASE("a lid falls by its weight as a pendulum does, and gains no energy") {
  const robot::RobotModel model = load_text(door_text("0 1 0"));
  // Hanging straight down is q = pi / 2 about y for a centre along x; 0.05 rad beside it.
  const double down = std::numbers::pi / 2;
  const auto world = make(pulled(passive(model, {.joint = "hinge"}, down - 0.05), 0));
  const auto energy = [&] {
    const double q = world->joints()[0], u = world->joint_speeds()[0];
    return 0.5 * kDoorInertia * u * u - 2 * 9.81 * 0.3 * std::sin(q);
  };
  const double start = energy();
  double most = start;
  std::vector<double> crossings;
  for (int i = 0; i < 5000; ++i) {
    const double before = world->joints()[0] - down;
    run(*world, 1);
    const double now = world->joints()[0] - down;
    if (before < 0 && now >= 0) crossings.push_back((i + before / (before - now)) * kDt);
    most = std::max(most, energy());
  }
  REQUIRE(crossings.size() >= 5);
  const double period =
      (crossings.back() - crossings.front()) / static_cast<double>(crossings.size() - 1);
  CHECK(period == doctest::Approx(2 * std::numbers::pi * std::sqrt(kDoorInertia / (2 * 9.81 * 0.3)))
                      .epsilon(2e-3));
  // Symplectic: the energy swings by a part in a hundred of what the motion has, and stays.
  const double motion = 2 * 9.81 * 0.3 * (1 - std::cos(0.05));
  CHECK(most - start < 0.02 * motion);
}

TEST_CASE("two doors one on the other keep their energy when nothing brakes them") {
  const std::string text =
      "<robot name='folding'>" + link_text("frame", 10) + link_text("upper", 1, "0.1 0.02 0.2") +
      link_text("lower", 1, "0.15 0 0.1") +
      joint_text("first", "continuous", "frame", "upper", "0 1 0") +
      joint_text("second", "continuous", "upper", "lower", "0 0.6 0.8", "0.3 0 0") + "</robot>";
  const robot::RobotModel model = load_text(text);
  for (const double dt : {0.002, 0.0005}) {
    ArticulationSpec spec;
    spec.model = &model;
    spec.driven = false;
    spec.joints = {{.joint = "first"}, {.joint = "second"}};
    spec.positions = {-1, 0.7};
    WorldSpec room = pulled(spec, 0);
    room.dt = dt;
    const auto world = make(room);
    const auto energy = [&] {
      const JointTree& tree = *world->stepper().articulations[0].tree;
      const Pose upper = world->frame_pose("upper"), lower = world->frame_pose("lower");
      const double height = upper.apply({0.1, 0.02, 0.2}).z() + lower.apply({0.15, 0, 0.1}).z();
      double kinetic = 0;
      for (std::size_t i = 0; i < 2; ++i) {
        for (std::size_t j = 0; j < 2; ++j) {
          kinetic += 0.5 * world->joint_speeds()[i] * tree.mass()[i][j] * world->joint_speeds()[j];
        }
      }
      return kinetic + 9.81 * height;
    };
    const double start = energy();
    double farthest = 0, fastest = 0, most = start;
    for (int i = 0; i < static_cast<int>(5 / dt); ++i) {
      run(*world, 1);
      farthest = std::max(farthest, std::fabs(energy() - start));
      most = std::max(most, energy());
      fastest = std::max(fastest, std::fabs(world->joint_speeds()[1]));
    }
    CHECK(fastest > 5);  // rad/s: without Coriolis forces it would be far off
    MESSAGE("dt ", dt, ": energy off by ", farthest, " J of ", start, ", most ", most,
            ", at the end ", energy());
    CHECK(farthest < 60 * dt);
  }
}

// A block with a handle on a slide over the table: what the arm pulls.
struct Handle {
  robot::RobotModel model = load_text(drawer_text());
  ArticulationSpec spec =
      passive(model, {.joint = "slide", .stiffness = 20, .damping = 5, .friction = 2}, 0.1);
  explicit Handle(const Vec3& at) {
    spec.name = "cabinet";
    spec.base.position = at - Vec3(0.1, 0, 0);
    spec.links = {{"drawer", box({0.012, 0.012, 0.03}), 1, 0}};
  }
};

TEST_CASE("a drawer pulled by its handle moves with the gripper without slip") {
  const Vec3 spot = kSpot + Vec3(0, 0, 0.03);
  const Handle handle(spot);
  Bench bench;
  if (!make_bench(&bench, {}, true, kDt, {handle.spec})) return;
  CHECK(bench.world->target_count() == 8);
  REQUIRE(bench.world->joints().size() == 9);
  close_on(&bench, spot);
  bench.run(200);
  // Along the slide; across it the drawer cannot follow what the arm does beside its line.
  const auto in_hand = [&] {
    return bench.world->frame_pose("drawer", 1).position.x() -
           bench.world->frame_pose(kTool).position.x();
  };
  const double before = in_hand();
  const double from = bench.world->joints()[8];
  double slip = 0;
  for (int i = 1; i <= 8; ++i) {
    bench.move(spot - Vec3(0.01 * (i - 1), 0, 0), spot - Vec3(0.01 * i, 0, 0), 1);
    slip = std::max(slip, std::fabs(in_hand() - before));
  }
  bench.run(300);
  bench.run(1500);  // what the tapering fingers hold comes into line with them, by micrometres
  const double held = in_hand(), opened = bench.world->joints()[8];
  double creep = 0;  // against the spring, which pulls with 1.6 N
  for (int i = 0; i < 20; ++i) {
    bench.run(50);
    creep = std::max(creep, std::fabs(in_hand() - held));
  }
  MESSAGE("opened by ", from - opened, " m, slip on the way ", 1e3 * slip, " mm, then ",
          1e3 * creep, " mm in 2 s");
  CHECK(from - opened == doctest::Approx(0.08).epsilon(0.03));
  CHECK(slip < 3e-4);  // the hand turns by a little on its way, the drawer cannot
  CHECK(creep < 1e-6);
  // Saved with the handle in the hand, and on in another world.
  const Handle other_handle(spot);
  Bench other;
  REQUIRE(make_bench(&other, {}, true, kDt, {other_handle.spec}));
  REQUIRE(other.world->restore(bench.world->save()).ok());
  other.target = bench.target;
  for (int i = 0; i < 3; ++i) {
    for (Bench* b : {&bench, &other}) {
      std::array<double, 8> q = b->target;
      q[0] += 0.02;
      b->go(q);
      b->run(100);
    }
    CHECK(bench.world->state_hash() == other.world->state_hash());
  }
}

TEST_CASE("a drawer falls asleep, costs nothing, and wakes when the arm comes near") {
  const Vec3 spot = kSpot + Vec3(0, 0, 0.03);
  const Handle handle(spot);
  Bench bench;
  if (!make_bench(&bench, {}, true, kDt, {handle.spec})) return;
  bench.run(300);
  const auto asleep = [&] { return bench.world->stepper().articulations[1].asleep; };
  CHECK(asleep());
  CHECK(!bench.world->stepper().articulations[0].asleep);
  CHECK(bench.world->joints()[8] == 0.1);
  close_on(&bench, spot);
  CHECK(!asleep());
  bench.grip(0.037);
  bench.run(100);
  bench.move(spot, spot + Vec3(0, 0, 0.12), 4);
  bench.run(400);
  CHECK(asleep());
}

TEST_CASE("a cube that stands in a drawer sleeps with it and wakes with it") {
  const robot::RobotModel model = load_text(drawer_text());
  WorldSpec spec = pulled(passive(model, {.joint = "slide", .damping = 2, .friction = 1}, 0.05), 0);
  spec.articulations[0].links = {{"drawer", box({0.1, 0.1, 0.01}), 1, 0}};
  spec.bodies = {
      {"cube", box(Vec3::Constant(0.02)), 500, 0.5, {Vec3(0.05, 0, 0.0301), Quat::Identity()}}};
  const auto still = make(spec);
  run(*still, 1000);
  CHECK(still->stepper().articulations[0].asleep);
  CHECK(still->stepper().bodies[0].asleep);
  REQUIRE(still->contacts().size() == 1);
  CHECK(still->contacts()[0].on_a.z() ==
        doctest::Approx(-0.032 * 9.81 * kDt).epsilon(0.01));  // on the link, asleep or not

  // Now the room pulls: both wake only when something touches them, so they are woken by hand.
  spec.gravity.x() = 1.5;
  const auto pulls = make(spec);
  REQUIRE(pulls->restore(still->save()).ok());
  pulls->lock_tilt(true);
  pulls->lock_tilt(false);
  run(*pulls, 300);
  CHECK(pulls->joints()[0] > 0.1);
  // Carried by friction: it has hardly moved against the drawer.
  const Vec3 apart = pulls->body(0).center - pulls->frame_pose("drawer").position;
  CHECK(apart.x() == doctest::Approx(0.0).epsilon(1).scale(0.002));
  CHECK(apart.z() == doctest::Approx(0.03).epsilon(0.01));
}

TEST_CASE("articulations that cannot be are refused by name") {
  const robot::RobotModel model = load_text(drawer_text());
  const auto refused = [&](auto change) {
    WorldSpec spec = pulled(passive(model, {.joint = "slide"}), 0);
    spec.articulations[0].name = "kitchen_cabinet";
    change(spec.articulations[0]);
    const auto world = World::create(spec);
    REQUIRE(!world.ok());
    CHECK(world.failure().code == Fault::kWorld);
    return world.failure().message;
  };
  CHECK(refused([](ArticulationSpec& a) { a.model = nullptr; }) ==
        "joints and links are given without a robot");
  CHECK(refused([](ArticulationSpec& a) { a.joints[0].joint = "hinge"; }) ==
        "no joint `hinge` in `kitchen_cabinet`");
  CHECK(refused([](ArticulationSpec& a) { a.joints[0].friction = -1; }) ==
        "the friction or armature of joint `slide` is negative or not finite");
  CHECK(refused([](ArticulationSpec& a) { a.joints.clear(), a.positions.clear(); }) ==
        "joint `slide` moves but has no drive");
  CHECK(refused([](ArticulationSpec& a) { a.base.position.x() = std::nan(""); }) ==
        "`kitchen_cabinet`'s base pose is not finite");
  CHECK(refused([](ArticulationSpec& a) {
          a.links = {{"door", box(Vec3::Constant(0.1)), 1, 0}};
        }) == "no link `door` in `kitchen_cabinet`");

  WorldSpec crowd;
  crowd.surface_z = -5;
  for (int i = 0; i <= kMaxJoints; ++i) {
    crowd.articulations.push_back(passive(model, {.joint = "slide"}));
  }
  const auto world = World::create(crowd);
  REQUIRE(!world.ok());
  CHECK(world.failure().message == "a world may have at most 32 driven joints");
}

}  // namespace
}  // namespace probe::world
