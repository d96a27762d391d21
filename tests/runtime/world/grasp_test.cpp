// The arm: drives, grasps that do not slip, presses that do not explode, states that are restored
// bit for bit.
#include <doctest/doctest.h>

#include <cmath>
#include <cstdlib>
#include <ctime>

#include "runtime/world/state.h"
#include "tests/runtime/world/arm_bench.h"

namespace probe::world {
namespace {

TEST_CASE("drives bring the arm to its targets and the mass matrix is felt as it should") {
  Bench bench;
  if (!make_bench(&bench, {})) return;
  std::array<double, 8> q = bench.target;
  q[0] += 0.2;
  q[3] -= 0.3;
  bench.go(q);
  bench.run(1500);
  for (std::size_t j = 0; j < 8; ++j) CHECK(std::fabs(bench.world->joints()[j] - q[j]) < 2e-4);
}

TEST_CASE("the error of an arm's swing halves with the substep") {
  const auto swing = [](double dt) {
    Bench bench;
    REQUIRE(make_bench(&bench, {}, false, dt));
    std::array<double, 8> q = bench.target;
    q[0] += 0.05;
    q[2] -= 0.04;
    bench.go(q);
    bench.run(static_cast<int>(0.1 / dt + 0.5));
    return Vec3(bench.world->joints()[0], bench.world->joints()[1], bench.world->joints()[2]);
  };
  if (!load_widowx().ok()) return;
  const Vec3 exact = swing(2e-5);
  const double coarse = (swing(0.002) - exact).norm(), fine = (swing(0.001) - exact).norm();
  MESSAGE("errors ", coarse, " ", fine);
  CHECK(coarse / fine == doctest::Approx(2).epsilon(0.15));
}

TEST_CASE("a grasped cube and carrot do not slip") {
  for (const bool carrot : {false, true}) {
    Bench bench;
    const auto shape = carrot ? object("carrot") : small_cube();
    BodySpec body = lying("object", shape, carrot ? 0.055 : 0.027, kSpot);
    if (carrot) body.pose.position.z() += 0.002;
    if (!make_bench(&bench, {body})) return;
    bench.run(250);  // settles
    const Vec3 center = bench.world->body(0).center;
    close_on(&bench, center);
    bench.move(center, center + Vec3(0, 0, 0.1), 5);
    bench.run(1500);  // what the tapering fingers hold comes into line with them, by micrometres
    const Pose before = bench.in_gripper(0);
    CHECK(bench.world->body(0).center.z() > center.z() + 0.08);
    double slip = 0, turn = 0;
    for (int i = 0; i < 10; ++i) {
      bench.run(100);
      const Pose now = bench.in_gripper(0);
      slip = std::max(slip, (now.position - before.position).norm());
      turn = std::max(turn, 2 * (before.rotation.conjugate() * now.rotation).vec().norm());
    }
    MESSAGE("carrot ", carrot, ": slip ", slip * 1e3, " mm, turn ", turn * 57.3, " deg in 2 s");
    CHECK(slip < 1e-6);
    CHECK(turn < 0.001 / 57.3);
  }
}

TEST_CASE("a state saved in mid-grasp and restored in a fresh world goes on bit for bit") {
  const std::vector<BodySpec> bodies{
      lying("cube", small_cube(), 0.027, kSpot),
      lying("carrot", object("carrot"), 0.055, kSpot + Vec3(0, 0.12, 0.005))};
  Bench first, second;
  if (!make_bench(&first, bodies, true)) return;
  REQUIRE(make_bench(&second, bodies, true));
  const auto lift = [](Bench* bench) {
    bench->run(600);
    close_on(bench, Vec3(kSpot));
    bench->move(kSpot, kSpot + Vec3(0, 0, 0.05), 3);
  };
  lift(&first);
  lift(&second);
  CHECK(first.world->state_hash() == second.world->state_hash());
  const std::vector<std::byte> state = first.world->save();
  Bench third;
  REQUIRE(make_bench(&third, bodies, true));
  third.run(17);
  REQUIRE(third.world->restore(state).ok());
  CHECK(third.world->contacts().size() == first.world->contacts().size());
  third.target = first.target;
  for (int i = 0; i < 5; ++i) {
    for (Bench* bench : {&first, &third}) {
      std::array<double, 8> q = bench->target;
      q[0] += 0.03;
      bench->go(q);
      bench->run(100);
    }
    CHECK(first.world->state_hash() == third.world->state_hash());
  }
  CHECK(!third.world->restore(std::span(state).first(state.size() - 1)).ok());
  CHECK(!third.world->restore(std::span(state).first(3)).ok());
  // A time at rest that counting on from would overflow: the only one of the robot, after the
  // joints.
  constexpr std::size_t kHead = 5 * 4 + 8 + 1, kJoint = 6 * 8 + 1;
  for (const std::byte last : {std::byte{0x7f}, std::byte{0xff}}) {
    std::vector<std::byte> bad = state;
    std::fill_n(bad.begin() + kHead + kJoint * kMaxJoints, 3, std::byte{0xff});
    bad[kHead + kJoint * kMaxJoints + 3] = last;
    const Status refused = third.world->restore(bad);
    REQUIRE(!refused.ok());
    CHECK(refused.failure().message == "the saved state has a time at rest that cannot be");
  }
}

TEST_CASE("pressing a cube into the table stays within forces and speeds") {
  Bench bench;
  if (!make_bench(&bench, {lying("cube", small_cube(), 0.027, kSpot)})) return;
  std::array<double, 8> q = bench.reach(kSpot + Vec3(0, 0, 0.08));
  q[6] = q[7] = 0.015;
  bench.world->set_joints(q);
  bench.target = q;
  double fastest = 0, lowest = 1;
  for (int i = 1; i <= 3000; ++i) {
    if (i % 100 == 1 && i <= 1500) {
      q = bench.reach(kSpot + Vec3(0, 0, 0.08 - 0.135 * (i + 99) / 1500));
      q[6] = q[7] = 0.014;
      bench.go(q);
    }
    bench.run(1);
    fastest = std::max(fastest, bench.world->body(0).velocity.norm());
    lowest = std::min(lowest, bench.world->body(0).center.z());
  }
  MESSAGE("pressed cube: fastest ", fastest, " m/s, lowest centre ", lowest - kTable);
  CHECK(fastest < 2.5);
  CHECK(lowest > kTable + 0.014);
}

TEST_CASE("worlds and actions that cannot be are refused with a reason") {
  Bench bench;
  if (!make_bench(&bench, {lying("cube", small_cube(), 0.027, kSpot)})) return;
  const auto refused = [&](auto change) {
    WorldSpec spec = bench.world->spec();
    change(spec);
    const auto world = World::create(spec);
    REQUIRE(!world.ok());
    CHECK(world.failure().code == Fault::kWorld);
    return world.failure().message;
  };
  CHECK(refused([](WorldSpec& s) { s.bodies[0].density = 0; }).find("cube") != std::string::npos);
  CHECK(refused([](WorldSpec& s) {
          auto shape = *s.bodies[0].shape;
          shape.unit_inertia(2, 2) *= 10;
          s.bodies[0].shape = std::make_shared<scene::CollisionShape>(shape);
        }).find("inertia") != std::string::npos);
  CHECK(refused([](WorldSpec& s) { s.articulations[0].joints[2].joint = "knee"; }).find("`knee`") !=
        std::string::npos);
  CHECK(refused([](WorldSpec& s) { s.articulations[0].links[1].name = "tail"; }).find("`tail`") !=
        std::string::npos);
  CHECK(refused([](WorldSpec& s) {
          s.articulations[0].joints.erase(s.articulations[0].joints.begin());
          s.articulations[0].positions.erase(s.articulations[0].positions.begin());
        }).find("has no drive") != std::string::npos);
  CHECK(refused([](WorldSpec& s) { s.bodies[0].pose.position.x() = std::nan(""); }).find("cube") !=
        std::string::npos);
  for (const double q : {4.0, -4.0}) {
    CHECK(refused([&](WorldSpec& s) {
            s.articulations[0].positions[2] = q;
          }).find("joint `elbow` starts at") != std::string::npos);
  }
  CHECK(refused([&](WorldSpec& s) { s.articulations[0].positions[6] = 0.05; })
            .find("joint `left_finger` starts at 0.050000, beyond its limits of 0.015000 and "
                  "0.037000") != std::string::npos);

  std::array<double, 8> targets = bench.target;
  targets[1] = std::nan("");
  bench.world->set_targets(targets);
  const Status nan = bench.world->step(1);
  REQUIRE(!nan.ok());
  CHECK(nan.failure().message.find("`shoulder`") != std::string::npos);
  WorldSpec fast = bench.world->spec();
  fast.gravity = Vec3(0, 0, 2e5);
  auto world = World::create(fast);
  REQUIRE(world.ok());
  const Status flown = world.value()->step(1);
  REQUIRE(!flown.ok());
  CHECK(flown.failure().message.find("faster than 50") != std::string::npos);
}

// A measurement, not a check: only on request, because shared machines are noisy.
TEST_CASE("speed") {
  if (std::getenv("VLAPROBE_SPEED") == nullptr) return;
  for (const bool sleeping : {false, true}) {
    Bench bench;
    std::vector<BodySpec> bodies{
        lying("cube", small_cube(), 0.027, kSpot),
        lying("carrot", object("carrot"), 0.055, kSpot + Vec3(0, 0.12, 0.005)),
        lying("plate", object("plate"), 0.021, kSpot + Vec3(-0.1, 0.1, 0.0)),
        lying("cube2", small_cube(), 0.027, kSpot + Vec3(-0.1, -0.1, 0))};
    if (!make_bench(&bench, bodies, sleeping)) return;
    bench.run(500);
    const auto seconds = [](auto f) {  // of this process's CPU time: the machine may be busy
      const std::clock_t start = std::clock();
      f();
      return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
    };
    const double moving = seconds([&] {
      for (int i = 0; i < 50; ++i) {
        std::array<double, 8> q = bench.target;
        q[0] = -0.018 + 0.1 * (i % 5);
        bench.go(q);
        bench.run(100);
      }
    });
    MESSAGE("sleeping ", sleeping, " moving: ", 10 / moving, " s/s");
    const Vec3 center = bench.world->body(0).center;
    close_on(&bench, center);
    const double grasping = seconds([&] {
      bench.move(center, center + Vec3(0, 0, 0.1), 5);
      bench.run(4500);
    });
    MESSAGE("sleeping ", sleeping, " grasping: ", 10 / grasping, " s/s");
  }
}

}  // namespace
}  // namespace probe::world
