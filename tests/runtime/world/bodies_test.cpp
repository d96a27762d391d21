// Free bodies without a robot: falling, sliding, spinning, hitting, stacking, sleeping.
#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>

#include "runtime/base/trig.h"
#include "runtime/scene/hull.h"
#include "runtime/world/stepper.h"
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

// A stepper of cubes without a world around it, so that bodies can start with velocities.
Stepper cubes(const std::vector<Vec3>& places) {
  Stepper s;
  s.sleeping = false;
  for (const Vec3& place : places) {
    Body b;
    b.mass = 1000 * cube->volume;
    b.inertia = 1000 * cube->unit_inertia;
    b.inertia_inverse = b.inertia.inverse();
    b.position = place;
    Collider c;
    c.shape = cube;
    c.friction = 0.5;
    c.body = static_cast<int>(s.bodies.size());
    c.local.half = Vec3::Constant(kHalf);
    c.part_boxes.resize(1);
    s.bodies.push_back(b);
    s.colliders.push_back(c);
  }
  make_pairs(s.colliders, 0, s.bodies.size(), {}, s.plane, &s.table);
  return s;
}

TEST_CASE(
    "a cube spinning flat on the table is slowed by its corners, stops and does not turn back") {
  Stepper s = cubes({Vec3(0, 0, kHalf)});
  s.ambient.gravity = Vec3(0, 0, -9.81);
  s.bodies[0].spin = Vec3(0, 0, 20);
  const double slope =
      0.75 * s.bodies[0].mass * 9.81 * std::sqrt(2.0) * kHalf / s.bodies[0].inertia(2, 2);
  for (int i = 0; i < 9; ++i) REQUIRE(s.advance().ok());
  CHECK((20 - s.bodies[0].spin.z()) / 0.018 == doctest::Approx(slope).epsilon(0.01));
  double lowest = 20;
  for (int i = 0; i < 100; ++i) {
    REQUIRE(s.advance().ok());
    lowest = std::min(lowest, s.bodies[0].spin.z());
  }
  CHECK(lowest > -1e-3);
  CHECK(std::fabs(s.bodies[0].spin.z()) < 1e-6);
}

TEST_CASE("what is damped slows by the formula, and at a finer step as the exponential does") {
  constexpr double kDamping = 0.02, kTurn = 1e-5, kSeconds = 0.5;  // N s/m, N m s/rad
  for (const double dt : {0.002, 0.0005}) {
    Stepper s = cubes({Vec3(0, 0, 5)});
    s.parameters.dt = dt;
    Body& body = s.bodies[0];
    body.drag = dt * kDamping;
    body.turn_drag = dt * kTurn;
    body.velocity = Vec3(0.3, 0, 0.4);
    body.spin = Vec3(3, -4, 0);
    const double slow = kDamping / body.mass, slow_turn = kTurn / body.inertia(0, 0);  // 1/s
    const int steps = static_cast<int>(std::lround(kSeconds / dt));
    for (int i = 0; i < steps; ++i) REQUIRE(s.advance().ok());
    CHECK(body.velocity.norm() ==
          doctest::Approx(0.5 * std::pow(1 + dt * slow, -steps)).epsilon(1e-12));
    CHECK(body.spin.norm() ==
          doctest::Approx(5 * std::pow(1 + dt * slow_turn, -steps)).epsilon(1e-12));
    // (1 + dt r)^-(t / dt) = exp(-r t) (1 + dt r^2 t / 2 + ..)
    CHECK(body.velocity.norm() / (0.5 * std::exp(-slow * kSeconds)) - 1 ==
          doctest::Approx(dt * slow * slow * kSeconds / 2).epsilon(0.02));
    CHECK(body.spin.norm() / (5 * std::exp(-slow_turn * kSeconds)) - 1 ==
          doctest::Approx(dt * slow_turn * slow_turn * kSeconds / 2).epsilon(0.02));
    CHECK(body.velocity.cross(Vec3(0.3, 0, 0.4)).norm() < 1e-15);
  }
}

TEST_CASE("what falls under damping comes to the speed at which it carries the weight") {
  WorldSpec spec = quiet_spec();
  spec.surface_z = -1000;
  BodySpec falling{"cube", cube, 1000, 0.5, at(0, 0, 0)};
  falling.damping = 0.5;
  spec.bodies.push_back(falling);
  const auto world = make(spec);
  run(world.get(), 1000);
  const double mass = 1000 * cube->volume;
  CHECK(world->body(0).velocity.z() == doctest::Approx(-mass * 9.81 / 0.5).epsilon(1e-9));
  // z(t) = -v (t - (1 - e^(-t / T)) T), T = m / d: two seconds are 37 T.
  const double v = mass * 9.81 / 0.5, time = mass / 0.5;
  CHECK(world->body(0).pose.position.z() == doctest::Approx(-v * (2 - time)).epsilon(1e-3));
}

TEST_CASE("a damped body that tumbles and hits never gains energy, however strong its damping") {
  const auto brick = box(0.01, 0.03, 0.05);
  for (const double damping : {1e-6, 1e-3, 10.0}) {
    Stepper s = cubes({Vec3(0, 0, 0.06)});
    s.ambient.gravity = Vec3(0, 0, -9.81);
    Body& body = s.bodies[0];
    body.mass = 1000 * brick->volume;
    body.inertia = 1000 * brick->unit_inertia;
    body.inertia_inverse = body.inertia.inverse();
    body.drag = body.turn_drag = s.parameters.dt * damping;
    s.colliders[0].shape = brick;
    s.colliders[0].local.half = Vec3(0.01, 0.03, 0.05);
    body.spin = Vec3(5, 7, -3);
    body.velocity = Vec3(0.2, 0.1, 0);
    const auto energy = [&] {
      const Vec3 w = body.axes.transpose() * body.spin;
      return 0.5 * body.mass * body.velocity.squaredNorm() + 0.5 * w.dot(body.inertia * w) +
             body.mass * 9.81 * body.position.z();
    };
    double before = energy();
    for (int i = 0; i < 1000; ++i) {
      REQUIRE(s.advance().ok());
      const double after = energy();
      // A substep's fall is that of its end: g^2 dt^2 m / 2 of rounding a substep.
      CHECK(after <= before + 0.5 * body.mass * 9.81 * 9.81 * 4e-6);
      before = after;
    }
    CHECK(body.position.z() > 0.009);
  }
}

TEST_CASE("an off-centre hit keeps both momenta and never gains energy") {
  Stepper s = cubes({Vec3(0, 0, 0.5), Vec3(0.04, 0.002, 0.5)});
  s.bodies[0].velocity = Vec3(0.5, 0, 0);
  const auto linear = [&] {
    return Vec3(s.bodies[0].mass * (s.bodies[0].velocity + s.bodies[1].velocity));
  };
  const auto angular = [&] {
    Vec3 l = Vec3::Zero();
    for (const Body& b : s.bodies) {
      l += b.mass * b.position.cross(b.velocity) +
           b.axes * (b.inertia * (b.axes.transpose() * b.spin));
    }
    return l;
  };
  const auto energy = [&] {
    double e = 0;
    for (const Body& b : s.bodies) {
      const Vec3 w = b.axes.transpose() * b.spin;
      e += 0.5 * b.mass * b.velocity.squaredNorm() + 0.5 * w.dot(b.inertia * w);
    }
    return e;
  };
  const Vec3 p = linear(), l = angular();
  double e = energy();
  for (int i = 0; i < 200; ++i) {
    REQUIRE(s.advance().ok());
    CHECK(energy() <= e * (1 + 1e-12));
    e = energy();
  }
  CHECK(s.bodies[1].velocity.x() > 0.2);
  CHECK((linear() - p).norm() < 1e-12 * p.norm());
  CHECK((angular() - l).norm() < 1e-12 * l.norm());
}

TEST_CASE("two balls without friction exchange what they have along their centres, nothing else") {
  const double radius = 0.02, speed = 0.6, offset = 0.02;
  Stepper s = cubes({Vec3(0, 0, 0.5), Vec3(0.1, offset, 0.5)});
  const auto ball = std::make_shared<scene::CollisionShape>(scene::make_sphere_shape(radius));
  for (Collider& c : s.colliders) {
    c.shape = ball;
    c.friction = 0;
    c.rounded = true;
    c.local.half = Vec3::Constant(radius);
  }
  for (Body& b : s.bodies) {
    b.mass = 1000 * ball->volume;
    b.inertia = 1000 * ball->unit_inertia;
    b.inertia_inverse = b.inertia.inverse();
  }
  s.table = {};
  make_pairs(s.colliders, 0, s.bodies.size(), {}, s.plane, &s.table);
  const Vec3 before(speed, 0, 0);
  s.bodies[0].velocity = before;
  for (int i = 0; i < 200; ++i) REQUIRE(s.advance().ok());
  const Vec3 a = s.bodies[0].velocity, b = s.bodies[1].velocity;
  CHECK((a + b - before).norm() < 1e-14);
  CHECK(s.bodies[0].spin.norm() < 1e-12);
  CHECK(s.bodies[1].spin.norm() < 1e-12);
  // They touch where the centres are 2 r apart: sin(angle) = offset / 2 r.
  const double sine = offset / (2 * radius), cosine = std::sqrt(1 - sine * sine);
  const Vec3 along(cosine, sine, 0);
  CHECK((b - 0.5 * before.dot(along) * along).norm() < 0.01 * speed);
  CHECK((a - (before - 0.5 * before.dot(along) * along)).norm() < 0.01 * speed);
  // What is left along the common direction is equal, and half the energy of that part is gone; to
  // the turn of that direction while the balls pass within a substep or two.
  const Vec3 n = b.normalized();
  CHECK(std::fabs((a - b).dot(n)) < 0.01 * speed);
  const double lost = before.squaredNorm() - a.squaredNorm() - b.squaredNorm();
  CHECK(lost == doctest::Approx(0.5 * before.dot(n) * before.dot(n)).epsilon(0.01));
}

TEST_CASE("a body spinning freely keeps its angular momentum and energy for ten seconds") {
  Body b;
  b.mass = 0.055;
  b.inertia = Vec3(1.1e-5, 7e-5, 7.4e-5).asDiagonal();
  b.inertia_inverse = b.inertia.inverse();
  for (const double speed : {5.0, 20.0}) {
    b.rotation = Quat::Identity();
    b.axes = Mat3::Identity();
    b.spin = speed * Vec3(0.6, 0.64, 0.48);
    const Vec3 momentum = b.inertia * b.spin;
    const double energy = b.spin.dot(momentum);
    for (int i = 0; i < 5000; ++i) {
      predict(&b, Ambient{}, 0.002);
      integrate(&b, Ambient{}, 0.002);
    }
    const Vec3 now = b.axes * (b.inertia * (b.axes.transpose() * b.spin));
    CHECK((now - momentum).norm() < 1e-10 * momentum.norm());
    CHECK(std::fabs(b.spin.dot(now) / energy - 1) < (speed < 10 ? 1e-5 : 1e-3));
  }
}

TEST_CASE(
    "sleepers lie still, report their impulses, and wake when something comes or their support "
    "goes") {
  WorldSpec spec = quiet_spec();
  spec.sleeping = true;
  spec.bodies.push_back({"plate", box(0.06, 0.06, 0.003), 300, 0.5, at(0, 0, 0.003)});
  for (int i = 0; i < 3; ++i) {
    spec.bodies.push_back(
        {"cube", cube, 1000, 0.5, at(0, 0, 0.006 + kHalf + 2 * kHalf * i, 0.3 * i)});
  }
  spec.bodies.push_back({"late", cube, 1000, 0.5, at(0.5, 0, kHalf)});
  const auto world = make(spec);
  run(world.get(), 1000);
  const Vec3 still = world->body(3).pose.position;
  CHECK(world->body(3).velocity == Vec3::Zero());
  CHECK(world->contacts().size() == 5);
  run(world.get(), 500);
  CHECK(world->body(3).pose.position == still);
  CHECK(world->contacts().size() == 5);
  // Set on top: the stack wakes and hardly moves.
  world->set_body(4, at(0, 0, still.z() + 2 * kHalf + 1e-5, 0.2));
  double fastest = 0;
  for (int i = 0; i < 300; ++i) {
    run(world.get(), 1);
    for (std::size_t b = 0; b < 4; ++b) fastest = std::max(fastest, world->body(b).velocity.norm());
  }
  MESSAGE("a woken stack moves at ", fastest, " m/s");
  CHECK(fastest < 1e-3);
  run(world.get(), 800);
  world->set_body(0, at(0.5, 0.5, 0.003));
  run(world.get(), 300);
  CHECK(world->body(3).pose.position.z() < still.z() - 0.005);
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
