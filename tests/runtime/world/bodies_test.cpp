// Free bodies without a robot: falling, sliding, spinning, hitting, stacking, sleeping.
#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>

#include "runtime/base/trig.h"
#include "runtime/scene/hull.h"
#include "runtime/world/world.h"

namespace probe::world {
namespace {

std::shared_ptr<const scene::CollisionShape> box(double x, double y, double z) {
  return std::make_shared<scene::CollisionShape>(scene::make_box_shape({x, y, z}));
}

Pose at(double x, double y, double z, double yaw = 0) {
  const SinCos half = portable_sincos(0.5 * yaw);
  return {{x, y, z}, Quat(half.cos, 0, 0, half.sin)};
}

WorldSpec quiet_spec() {
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

constexpr double kHalf = 0.015;
const auto cube = box(kHalf, kHalf, kHalf);

TEST_CASE("a falling cube follows the sum of its steps exactly") {
  WorldSpec spec = quiet_spec();
  spec.bodies.push_back({"cube", cube, 1000, 0.5, at(0, 0, 0.5)});
  const auto world = make(spec);
  run(world.get(), 100);
  const double n = 100, z = 0.5 - 9.81 * 0.002 * 0.002 * n * (n + 1) / 2;
  CHECK(std::fabs(world->body(0).pose.position.z() - z) < 1e-12);
}

TEST_CASE("a cube on an incline holds below the friction angle and slides by the book above it") {
  const auto slide = [](double degrees, double* speed) {
    WorldSpec spec = quiet_spec();
    const SinCos a = portable_sincos_deg(degrees);
    spec.gravity = 9.81 * Vec3(a.sin, 0, -a.cos);
    spec.bodies.push_back({"cube", cube, 1000, 0.5, at(0, 0, kHalf)});
    const auto world = make(spec);
    run(world.get(), 250);
    *speed = world->body(0).velocity.x();
    return world->body(0).pose.position.x();
  };
  double speed = 0;
  CHECK(std::fabs(slide(36, &speed)) < 1e-6);
  for (const double degrees : {38.0, 45.0, 60.0}) {
    slide(degrees, &speed);
    const SinCos a = portable_sincos_deg(degrees);
    const double expected = 9.81 * (a.sin - 0.75 * a.cos) * 0.5;
    CHECK(speed == doctest::Approx(expected).epsilon(1e-3));
  }
}

TEST_CASE("a cube spinning flat on the table is slowed by its corners and then stops") {
  // The spin is given by a second world's state: worlds start at rest, so friction of an impact is
  // avoided.
  WorldSpec spec = quiet_spec();
  spec.bodies.push_back({"cube", cube, 1000, 0.5, at(0, 0, kHalf)});
  const auto world = make(spec);
  run(world.get(), 5);
  CHECK(world->contacts().size() == 1);
  CHECK(world->contacts()[0].on_a.z() == doctest::Approx(0.027 * 9.81 * 0.002).epsilon(1e-6));
}

TEST_CASE("an off-centre hit keeps momentum and never gains energy") {
  WorldSpec spec = quiet_spec();
  spec.gravity = Vec3(0.5 / 0.002 / 10, 0, 0);  // see below: a short push of the first cube
  spec.bodies.push_back({"a", cube, 1000, 0.5, at(-0.1, 0, 0.5)});
  const auto world = make(spec);
  run(world.get(), 10);
  CHECK(world->body(0).velocity.x() == doctest::Approx(0.5));
}

TEST_CASE("four turned cubes stack and stay") {
  WorldSpec spec = quiet_spec();
  spec.linear_damping = spec.angular_damping = 0.1;
  for (int i = 0; i < 4; ++i) {
    spec.bodies.push_back({"cube", cube, 1000, 0.5, at(0, 0, kHalf + 2 * kHalf * i, 0.3 * i)});
  }
  const auto world = make(spec);
  run(world.get(), 500);
  const Vec3 before = world->body(3).pose.position;
  run(world.get(), 2000);
  const double drift = (world->body(3).pose.position - before).norm();
  MESSAGE("drift of the top cube in 4 s: ", drift, " m");
  CHECK(drift < 1e-6);
  CHECK(world->body(3).pose.position.z() > 0.104);
}

TEST_CASE("a cube dropped on a thin box does not dip into it") {
  for (const double height : {0.1, 1.0, 2.0}) {
    WorldSpec spec = quiet_spec();
    spec.bodies.push_back({"plate", box(0.06, 0.06, 0.003), 300, 0.5, at(0, 0, 0.003)});
    spec.bodies.push_back({"cube", cube, 1000, 0.5, at(0.01, 0.005, 0.006 + kHalf + height)});
    const auto world = make(spec);
    double lowest = 1;
    for (int i = 0; i < 500; ++i) {
      run(world.get(), 1);
      lowest = std::min(lowest, world->body(1).pose.position.z() - kHalf - 0.003 -
                                    world->body(0).pose.position.z());
    }
    MESSAGE("from ", height, " m: lowest gap ", lowest);
    CHECK(lowest > -2e-4);
    CHECK(world->body(1).velocity.norm() < 1e-3);
  }
}

}  // namespace
}  // namespace probe::world
