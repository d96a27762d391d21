// Fixtures, round shapes, links that hit each other, and impulses summed over a control step.
#include <doctest/doctest.h>

#include <cmath>

#include "tests/runtime/world/arm_bench.h"

namespace probe::world {
namespace {

using scene::CollisionShape;

std::shared_ptr<const CollisionShape> shared(CollisionShape shape) {
  return std::make_shared<CollisionShape>(std::move(shape));
}

// Below z = 0, as far as a room goes: 20 m wide, 1 m deep.
CollisionShape half_space() {
  CollisionShape slab = scene::make_box_shape({10, 10, 0.5});
  slab.center_of_mass = Vec3(0, 0, -0.5);
  return slab;
}

Pose at(double x, double y, double z) { return {{x, y, z}, Quat::Identity()}; }

WorldSpec quiet() {
  WorldSpec spec;
  spec.sleeping = false;
  spec.linear_damping = spec.angular_damping = 0;
  return spec;
}

std::unique_ptr<World> make(const WorldSpec& spec) {
  auto world = World::create(spec);
  REQUIRE_MESSAGE(world.ok(), (world.ok() ? "" : to_text(world.failure())));
  return std::move(world).value();
}

void run(World* world, int substeps) {
  const Status status = world->step(substeps);
  REQUIRE_MESSAGE(status.ok(), (status.ok() ? "" : to_text(status.failure())));
}

// A basin of a floor and walls of several boards each, floor at 0.
std::shared_ptr<const CollisionShape> basin() {
  std::vector<std::vector<Vec3>> boards;
  const auto board = [&](const Vec3& low, const Vec3& high) {
    boards.emplace_back();
    for (int i = 0; i < 8; ++i) {
      boards.back().emplace_back(i & 1 ? high.x() : low.x(), i & 2 ? high.y() : low.y(),
                                 i & 4 ? high.z() : low.z());
    }
  };
  for (int k = -5; k < 5; ++k) {
    const double a = 0.04 * k, b = 0.04 * (k + 1);
    board({a, -0.2, -0.01}, {b, 0.2, 0});
    board({a, -0.21, -0.01}, {b, -0.2, 0.1});
    board({a, 0.2, -0.01}, {b, 0.21, 0.1});
    board({-0.21, a, -0.01}, {-0.2, b, 0.1});
    board({0.2, a, -0.01}, {0.21, b, 0.1});
  }
  auto shape = scene::make_collision_shape(boards, "basin");
  REQUIRE(shape.ok());
  return shared(std::move(shape).value());
}

TEST_CASE("a cube in a basin lies on its floor, stays inside its walls and names it as a party") {
  WorldSpec spec = quiet();
  spec.surface_z = -1;
  spec.fixtures.push_back({"basin", basin(), at(0.5, 0.1, 0.3), 1.0});
  spec.bodies.push_back({"cube", shared(scene::make_box_shape({0.015, 0.015, 0.015})), 1000, 0.5,
                         at(0.53, 0.1, 0.36)});
  const auto world = make(spec);
  run(world.get(), 500);
  CHECK(world->body(0).pose.position.z() == doctest::Approx(0.315).epsilon(1e-3));
  REQUIRE(world->contacts().size() == 1);
  CHECK(world->contacts()[0].b == Party{PartyKind::kFixture, 0});
  CHECK(world->contacts()[0].a == Party{PartyKind::kBody, 0});
  CHECK(world->contacts()[0].on_a.z() == doctest::Approx(0.027 * 9.81 * 0.002).epsilon(1e-6));
  // Pushed against a wall by a tilted gravity, and over a seam of the floor.
  spec.gravity = Vec3(9, 0, -9.81);
  const auto tilted = make(spec);
  run(tilted.get(), 1500);
  CHECK(tilted->body(0).pose.position.x() == doctest::Approx(0.685).epsilon(1e-3));
  CHECK(tilted->body(0).velocity.norm() < 1e-6);
}

TEST_CASE("a body sleeps on a fixture, and a fixture wakes nothing") {
  WorldSpec spec = quiet();
  spec.sleeping = true;
  spec.surface_z = -1;
  spec.fixtures.push_back({"basin", basin(), at(0, 0, 0), 1.0});
  spec.bodies.push_back(
      {"cube", shared(scene::make_box_shape({0.015, 0.015, 0.015})), 1000, 0.5, at(0, 0, 0.015)});
  const auto world = make(spec);
  run(world.get(), 400);
  CHECK(world->body(0).velocity == Vec3::Zero());
  const Vec3 still = world->body(0).pose.position;
  run(world.get(), 400);
  CHECK(world->body(0).pose.position == still);
  REQUIRE(world->contacts().size() == 1);
  // A sleeper's frozen impulses count in the sums.
  REQUIRE(world->contact_sums().size() == 1);
  CHECK(world->contact_sums()[0].on_a.z() ==
        doctest::Approx(400 * world->contacts()[0].on_a.z()).epsilon(1e-9));
}

TEST_CASE("sums over a step are the momentum that contacts gave") {
  WorldSpec spec = quiet();
  spec.sleeping = true;
  const double mass = 0.027;
  spec.bodies.push_back(
      {"cube", shared(scene::make_box_shape({0.015, 0.015, 0.015})), 1000, 0.5, at(0, 0, 0.1)});
  const auto world = make(spec);
  // Falls, lands, rests and falls asleep, in steps of several lengths.
  for (const int n : {37, 100, 200, 300}) {
    const Vec3 before = mass * world->body(0).velocity;
    run(world.get(), n);
    Vec3 given = Vec3::Zero();
    for (const ContactImpulse& c : world->contact_sums()) given += c.on_a;
    const Vec3 expected =
        mass * world->body(0).velocity - before + Vec3(0, 0, mass * 9.81 * 0.002 * n);
    CHECK((given - expected).norm() < 1e-6);
  }
}

TEST_CASE("primitives have the textbook volume and inertia") {
  const double r = 0.02, h = 0.03, pi = 3.14159265358979;
  const CollisionShape ball = scene::make_sphere_shape(r);
  CHECK(ball.volume == doctest::Approx(4 * pi / 3 * r * r * r));
  CHECK(ball.unit_inertia(0, 0) == doctest::Approx(0.4 * ball.volume * r * r));
  CHECK(ball.bounding_radius == doctest::Approx(r));
  const CollisionShape capsule = scene::make_capsule_shape(r, h);
  CHECK(capsule.volume == doctest::Approx(2 * pi * r * r * h + 4 * pi / 3 * r * r * r));
  CHECK(capsule.bounding_radius == doctest::Approx(r + h));
  const CollisionShape cylinder = scene::make_cylinder_shape(r, h);
  CHECK(cylinder.volume == doctest::Approx(2 * pi * r * r * h).epsilon(0.007));
  CHECK(cylinder.unit_inertia(2, 2) ==
        doctest::Approx(0.5 * cylinder.volume * r * r).epsilon(0.01));
  CHECK(cylinder.parts[0].vertices.size() + cylinder.parts[0].faces.size() ==
        cylinder.parts[0].edges.size() + 2);
}

TEST_CASE("joined shapes have the mass of their sum, and each part lies where it was put") {
  const double r = 0.02, pi = 3.14159265358979;
  const Quat flat(std::sqrt(0.5), 0, std::sqrt(0.5), 0);  // z to x
  // Two balls on a bar that was made along z and turned along x.
  const CollisionShape bar = scene::make_box_shape({0.005, 0.01, 0.05});
  const CollisionShape joined = scene::join_shapes({{bar, Pose{{0.3, 0, 0}, flat}},
                                                    {scene::make_sphere_shape(r), at(0.23, 0, 0)},
                                                    {scene::make_sphere_shape(r), at(0.37, 0, 0)}});
  const double ball = 4 * pi / 3 * r * r * r, box = 8 * 0.005 * 0.01 * 0.05;
  CHECK(joined.volume == doctest::Approx(2 * ball + box));
  CHECK((joined.center_of_mass - Vec3(0.3, 0, 0)).norm() < 1e-12);
  // About x: bar of 1 cm by 2 cm, and the balls; about z also their distance of 7 cm.
  const double about_x = box / 3 * (0.005 * 0.005 + 0.01 * 0.01) + 2 * ball * 0.4 * r * r;
  const double about_z =
      box / 3 * (0.05 * 0.05 + 0.01 * 0.01) + 2 * ball * (0.4 * r * r + 0.07 * 0.07);
  CHECK(joined.unit_inertia(0, 0) == doctest::Approx(about_x));
  CHECK(joined.unit_inertia(2, 2) == doctest::Approx(about_z));
  CHECK(joined.bounding_radius == doctest::Approx(0.07 + r));
  // It lies on its balls, the bar in the air.
  WorldSpec spec = quiet();
  spec.bodies.push_back({"dumbbell", shared(joined), 1000, 0.5, at(-0.3, 0, r + 0.01)});
  const auto world = make(spec);
  run(world.get(), 500);
  CHECK(world->body(0).center.z() == doctest::Approx(r).epsilon(5e-3));
  CHECK(world->body(0).velocity.norm() < 1e-6);
}

TEST_CASE("a ball rolls down an incline as the formula says, on the surface and on a fixture") {
  const double angle = 20;
  const SinCos a = portable_sincos_deg(angle);
  for (const bool on_fixture : {false, true}) {
    for (const bool capsule : {false, true}) {
      WorldSpec spec = quiet();
      spec.gravity = 9.81 * Vec3(a.sin, 0, -a.cos);
      if (on_fixture) {
        spec.surface_z = -0.9;
        spec.fixtures.push_back({"floor", shared(half_space()), at(0, 0, 0), 1.0});
      }
      // A capsule across the slope rolls as a solid between ball and cylinder.
      const auto shape =
          shared(capsule ? scene::make_capsule_shape(0.02, 0.03) : scene::make_sphere_shape(0.02));
      Pose start = at(0, 0, 0.02);
      if (capsule) start.rotation = Quat(std::sqrt(0.5), std::sqrt(0.5), 0, 0);  // axis along y
      spec.bodies.push_back({"round", shape, 1000, 0.5, start});
      const auto world = make(spec);
      run(world.get(), 250);
      const double about =
          (capsule ? shape->unit_inertia(2, 2) : shape->unit_inertia(0, 0)) / shape->volume;
      const double expected = 9.81 * a.sin * 0.5 / (1 + about / (0.02 * 0.02));
      CHECK(world->body(0).velocity.x() == doctest::Approx(expected).epsilon(2e-3));
      CHECK(world->body(0).spin.y() ==
            doctest::Approx(world->body(0).velocity.x() / 0.02).epsilon(2e-3));
      CHECK(std::fabs(world->body(0).velocity.y()) < 1e-6);
      CHECK(std::fabs(world->body(0).pose.position.z() - 0.02) < 1e-4);
    }
  }
}

TEST_CASE("round bodies rest on boxes and on one another and stay") {
  WorldSpec spec = quiet();
  spec.linear_damping = spec.angular_damping = 0.1;
  const Quat lying(std::sqrt(0.5), 0, std::sqrt(0.5), 0);  // axis along x
  spec.bodies.push_back(
      {"block", shared(scene::make_box_shape({0.05, 0.02, 0.01})), 1000, 0.5, at(0, 0, 0.01)});
  // Longer than the block: it lies across two edges.
  spec.bodies.push_back({"rod", shared(scene::make_capsule_shape(0.01, 0.08)), 1000, 0.5,
                         Pose{{0, 0, 0.0301}, lying}});
  spec.bodies.push_back(
      {"tin", shared(scene::make_cylinder_shape(0.02, 0.03)), 1000, 0.5, at(0.3, 0, 0.03)});
  spec.bodies.push_back(
      {"ball", shared(scene::make_sphere_shape(0.015)), 1000, 0.5, at(0.3, 0, 0.0751)});
  const auto world = make(spec);
  run(world.get(), 250);
  std::vector<Vec3> before;
  for (std::size_t b = 0; b < 4; ++b) before.push_back(world->body(b).pose.position);
  run(world.get(), 1000);
  // The ball's place on the tin is one of many equal ones: nothing holds it there.
  for (std::size_t b = 0; b < 4; ++b) {
    CHECK_MESSAGE((world->body(b).pose.position - before[b]).norm() < (b == 3 ? 1e-5 : 1e-6),
                  spec.bodies[b].name);
  }
  CHECK(world->body(1).pose.position.z() == doctest::Approx(0.03).epsilon(5e-3));
  CHECK(world->body(3).pose.position.z() == doctest::Approx(0.075).epsilon(5e-3));
}

TEST_CASE("two balls that meet keep momentum, and a ball falls past a box's corner") {
  WorldSpec spec = quiet();
  spec.gravity = Vec3(0, 0, -9.81);
  spec.bodies.push_back(
      {"block", shared(scene::make_box_shape({0.03, 0.03, 0.03})), 5000, 0.5, at(0, 0, 0.03)});
  spec.bodies.push_back(
      {"ball", shared(scene::make_sphere_shape(0.01)), 1000, 0.5, at(0.0345, 0.0345, 0.2)});
  const auto world = make(spec);
  double lowest = 1;  // distance of the ball from the block's nearest corner
  for (int i = 0; i < 300; ++i) {
    run(world.get(), 1);
    const Pose block = world->body(0).pose;
    lowest = std::min(lowest, (world->body(1).center - block.apply({0.03, 0.03, 0.03})).norm());
  }
  CHECK(lowest > 0.0099);
  CHECK(world->body(1).center.z() < 0.02);
}

TEST_CASE("the grasp holds a ball and a tin") {
  for (const bool tin : {false, true}) {
    Bench bench;
    const auto shape =
        shared(tin ? scene::make_cylinder_shape(0.02, 0.02) : scene::make_sphere_shape(0.02));
    if (!make_bench(&bench, {lying("round", shape, 0.03, kSpot + Vec3(0, 0, 0.005))})) return;
    close_on(&bench, kSpot + Vec3(0, 0, 0.005));
    bench.move(kSpot + Vec3(0, 0, 0.005), kSpot + Vec3(0, 0, 0.1), 5);
    bench.run(250);
    const Pose before = bench.in_gripper(0);
    CHECK(bench.world->body(0).center.z() > kTable + 0.08);
    bench.run(1000);
    const double slip = (bench.in_gripper(0).position - before.position).norm();
    MESSAGE(std::string(tin ? "tin" : "ball"), ": slip ", slip * 1e3, " mm in 2 s");
    CHECK(slip < 1e-5);
  }
}

TEST_CASE(
    "self-collision leaves out neighbours and what touches at the start, and stops the rest") {
  auto robot = load_widowx();
  if (!robot.ok()) {
    MESSAGE("skipped: ", to_text(robot.failure()));
    return;
  }
  WorldSpec spec = table_spec(robot.value()->spec);
  CHECK(make(spec)->excluded_links().empty());
  spec.articulations[0].self_collision = true;
  const auto world = make(spec);
  const auto& links = spec.articulations[0].links;
  REQUIRE(!world->excluded_links().empty());
  for (const ExcludedLinks& out : world->excluded_links()) {
    CHECK(out.a < out.b);
    CHECK(out.b < links.size());
    std::string why = "touching at the start";
    if (out.reason == ExcludedLinks::Reason::kRigid) why = "rigid";
    if (out.reason == ExcludedLinks::Reason::kNeighbours) why = "neighbours";
    MESSAGE(links[out.a].name, " - ", links[out.b].name, ": ", why);
  }
  run(world.get(), 100);
  CHECK(world->contacts().empty());
  // Folded onto itself: the gripper meets the upper arm or the base and stops there.
  std::vector<double> q(spec.articulations[0].positions);
  q[1] = -1.7;
  q[2] = 1.55;
  q[4] = 2.1;
  world->set_targets(q);
  bool hit = false;
  for (int i = 0; i < 30; ++i) {
    run(world.get(), 100);
    for (const ContactImpulse& c : world->contacts()) {
      hit = hit || (c.a.kind == PartyKind::kLink && c.b.kind == PartyKind::kLink);
    }
  }
  CHECK(hit);
  for (const double u : world->joint_speeds()) CHECK(std::fabs(u) < 1e-2);
}

}  // namespace
}  // namespace probe::world
