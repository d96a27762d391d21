// Fingers driven into the table beside and through an object: more friction than the sweeps can
// settle. Such a jam may hold, slide or spit the object out, but nothing is flung.
#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "tests/runtime/world/arm_bench.h"

namespace probe::world {
namespace {

struct Fastest {
  double body = 0;   // m/s
  double joint = 0;  // rad/s or m/s
};

// The open gripper over a carrot goes down, tilting at random, twelve control steps long.
Fastest press(unsigned seed) {
  std::mt19937_64 random(seed);
  const auto number = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(random() >> 11) * 0x1p-53;
  };
  Bench bench;
  const double x = number(-0.04, 0.04), y = number(-0.04, 0.04);
  REQUIRE(make_bench(&bench, {lying("carrot", object("carrot"), 0.055, kSpot + Vec3(x, y, 0.002))},
                     true));
  const double dx = number(-0.03, 0.03), dy = number(-0.03, 0.03);
  std::array<double, 8> q = bench.reach(kSpot + Vec3(dx, dy, 0.06), number(-1.5, 1.5));
  q[6] = q[7] = 0.037;
  bench.world->set_joints(q);
  Fastest fastest;
  for (int control_step = 0; control_step < 12; ++control_step) {
    const auto now = bench.world->joints();
    for (std::size_t j = 0; j < 6; ++j) q[j] = now[j] + number(-0.04, 0.04);
    q[1] += number(0, 0.2);
    q[4] += number(-0.5, 0.5);
    q[2] += number(-0.2, 0.2);
    q[6] = q[7] = 0.038;
    bench.go(q);
    for (int i = 0; i < 100; ++i) {
      bench.run(1);
      fastest.body = std::max(fastest.body, bench.world->body(0).velocity.norm());
      for (const double u : bench.world->joint_speeds())
        fastest.joint = std::max(fastest.joint, std::fabs(u));
    }
  }
  return fastest;
}

TEST_CASE("fingers jammed between a carrot and the table fling neither the carrot nor the arm") {
  Fastest fastest;
  for (unsigned seed = 0; seed < 100; ++seed) {
    const Fastest here = press(seed);
    fastest.body = std::max(fastest.body, here.body);
    fastest.joint = std::max(fastest.joint, here.joint);
  }
  MESSAGE("100 jams: carrot up to ", fastest.body, " m/s, joints up to ", fastest.joint, " rad/s");
  CHECK(fastest.body < 5);
  CHECK(fastest.joint < 6);
}

}  // namespace
}  // namespace probe::world
