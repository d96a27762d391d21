// Bodies that are led: what they push, what they pass through, and when they are free again.
#include <doctest/doctest.h>

#include <cmath>

#include "runtime/scene/hull.h"
#include "tests/runtime/world/arm_bench.h"

namespace probe::world {
namespace {

constexpr double kHalf = 0.015;

std::shared_ptr<const scene::CollisionShape> led_cube() {
  return std::make_shared<scene::CollisionShape>(scene::make_box_shape({kHalf, kHalf, kHalf}));
}

// Cubes on the surface at these places along x.
std::unique_ptr<World> cubes_at(std::initializer_list<double> places) {
  WorldSpec spec;
  for (const double x : places)
    spec.bodies.push_back({"cube", led_cube(), 1000, 0.5, {{x, 0, kHalf}, Quat::Identity()}});
  auto world = World::create(spec);
  REQUIRE_MESSAGE(world.ok(), (world.ok() ? "" : to_text(world.failure())));
  return std::move(world).value();
}

TEST_CASE("a led body moves at its velocity: neither weight nor friction act on it") {
  const auto world = cubes_at({0});
  REQUIRE(world->step(50).ok());
  world->lead(0, {0.05, -0.02, 0});
  const Vec3 before = world->body(0).center;
  REQUIRE(world->step(500).ok());
  const Vec3 way = world->body(0).center - before;
  CHECK(way.x() == doctest::Approx(0.05).epsilon(1e-12));
  CHECK(way.y() == doctest::Approx(-0.02).epsilon(1e-12));
  CHECK(way.z() == 0);
  CHECK(world->is_led(0));
}

TEST_CASE("a led body pushes what is free and is not slowed by it, and wakes what sleeps") {
  const auto world = cubes_at({0, 0.05});
  REQUIRE(world->step(1000).ok());  // asleep by now
  world->lead(0, {0.05, 0, 0});
  REQUIRE(world->step(1000).ok());
  CHECK(world->body(0).center.x() == doctest::Approx(0.1).epsilon(1e-9));
  CHECK(world->body(1).center.x() == doctest::Approx(0.1 + 2 * kHalf).epsilon(1e-3));
  CHECK(world->body(1).velocity.x() == doctest::Approx(0.05).epsilon(1e-2));
}

TEST_CASE("what rides on a led body is carried by friction") {
  WorldSpec spec;
  spec.bodies.push_back({"low", led_cube(), 1000, 0.5, {{0, 0, kHalf}, Quat::Identity()}});
  spec.bodies.push_back({"high", led_cube(), 1000, 0.5, {{0, 0, 3 * kHalf}, Quat::Identity()}});
  auto made = World::create(spec);
  REQUIRE(made.ok());
  World& world = **made;
  REQUIRE(world.step(200).ok());
  world.lead(0, {0.05, 0, 0});
  REQUIRE(world.step(1000).ok());
  CHECK(world.body(0).center.x() == doctest::Approx(0.1).epsilon(1e-5));  // settling moved it
  CHECK(world.body(1).center.x() == doctest::Approx(0.1).epsilon(0.02));
}

TEST_CASE("two led bodies, and a led one and what stands still, do not hinder one another") {
  const auto world = cubes_at({0, 0.05});
  world->lead(0, {0.05, 0, 0});
  world->lead(1, {-0.05, 0, 0});
  REQUIRE(world->step(500).ok());
  CHECK(world->body(0).center.x() == doctest::Approx(0.05).epsilon(1e-9));
  CHECK(std::abs(world->body(1).center.x()) < 1e-9);
  CHECK(world->contacts().empty());
}

TEST_CASE("a led body that is let go slides to rest as any body does") {
  const auto world = cubes_at({0});
  REQUIRE(world->step(50).ok());
  world->lead(0, {0.2, 0, 0});
  REQUIRE(world->step(100).ok());
  world->let_go(0);
  const double from = world->body(0).center.x();
  REQUIRE(world->step(500).ok());
  // v^2 / (2 mu g), mu the mean of both materials; the surface's is 1 by default.
  const double mu = 0.5 * (0.5 + world->spec().surface_friction);
  CHECK(world->body(0).center.x() - from ==
        doctest::Approx(0.2 * 0.2 / (2 * mu * 9.81)).epsilon(0.05));
  CHECK(world->body(0).velocity.norm() < 1e-3);
}

TEST_CASE("a robot's touch ends that a body is led, a touch of other bodies does not") {
  Bench bench;
  REQUIRE(make_bench(&bench, {lying("cube", small_cube(), 0.03, kSpot)}));
  bench.world->lead(0, Vec3::Zero());
  REQUIRE(bench.world->step(100).ok());
  CHECK(bench.world->is_led(0));
  CHECK(*bench.world->led_to(0) == bench.world->body(0).center);
  close_on(&bench, kSpot);
  CHECK_FALSE(bench.world->is_led(0));
  // Where it was then is kept, whatever the gripper does with it.
  const Vec3 touched = *bench.world->led_to(0);
  CHECK((touched - bench.world->body(0).center).norm() < 0.01);
  const auto state = bench.world->save();
  bench.world->set_body(0, {{0.4, 0.1, 0.9}, Quat::Identity()});
  CHECK_FALSE(bench.world->led_to(0));
  REQUIRE(bench.world->restore(state).ok());
  CHECK(*bench.world->led_to(0) == touched);
  CHECK(bench.world->save() == state);

  const auto world = cubes_at({0, 0.04});
  world->lead(0, {0.05, 0, 0});
  REQUIRE(world->step(500).ok());
  CHECK(world->is_led(0));
}

TEST_CASE(
    "a world with led bodies goes on bit for bit from its saved state, and others save as ever") {
  const auto world = cubes_at({0, 0.05});
  REQUIRE(world->step(50).ok());
  const std::size_t free_size = world->save().size();
  world->lead(0, {0.05, 0, 0});
  REQUIRE(world->step(200).ok());
  const auto state = world->save();
  REQUIRE(world->step(300).ok());
  const Sha256 there = world->state_hash();
  const auto again = cubes_at({0, 0.05});
  REQUIRE(again->restore(state).ok());
  CHECK(again->is_led(0));
  CHECK_FALSE(again->is_led(1));
  REQUIRE(again->step(300).ok());
  CHECK(again->state_hash() == there);
  again->let_go(0);
  CHECK(cubes_at({0, 0.05})->save().size() <= free_size);
  std::vector<std::byte> torn(state.begin(), state.end() - 1);
  CHECK_FALSE(again->restore(torn).ok());
}

}  // namespace
}  // namespace probe::world
