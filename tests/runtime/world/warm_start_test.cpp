// What a substep begins with where something is soft.
#include <doctest/doctest.h>

#include <vector>

#include "runtime/world/sweeps.h"

using namespace probe;
using namespace probe::world;

namespace {

// Joints of 1 kg along the normals of contacts, one each, and the impulses of the last substep.
struct Rig {
  explicit Rig(std::vector<double> gives) {
    problem.lanes = problem.joints = static_cast<int>(gives.size() + 3) / 4 * 4;
    const std::size_t lanes = static_cast<std::size_t>(problem.lanes);
    problem.columns.assign(gives.size() * 8 * lanes, 0.0);
    problem.bodies = &bodies;
    problem.contacts.resize(gives.size());
    problem.rows.resize(gives.size());
    for (std::size_t i = 0; i < gives.size(); ++i) {
      ContactRows& row = problem.rows[i];
      row.columns = problem.columns.data() + i * 8 * lanes;
      row.columns[i] = row.columns[lanes + i] = 1;  // of the normal: J and W J^T
      row.give = gives[i];
      row.rows[kNormal].impulse = 1;
    }
  }
  double impulse(std::size_t contact) const { return problem.rows[contact].rows[kNormal].impulse; }

  std::vector<Body> bodies;
  Problem problem;
  JointResponse response{};
};

}  // namespace

TEST_CASE(
    "what is soft begins a substep with what the drives press with now, and nothing else does") {
  Rig rig({0.25, 0});  // a finger, and a drawer with something in it
  rig.problem.u[0] = -1.5;
  rig.problem.u[1] = -0.7;
  warm_start(&rig.problem, rig.response);
  // u + l + give l = 0
  CHECK(rig.impulse(0) == doctest::Approx(1.2));
  CHECK(rig.problem.u[0] == doctest::Approx(-0.3));
  CHECK(rig.impulse(1) == 1.0);
  CHECK(rig.problem.u[1] == doctest::Approx(0.3));
  CHECK(rig.problem.contacts[0].start[kNormal] == rig.impulse(0));
}

TEST_CASE("a substep in which nothing is soft begins with the impulses of the last one") {
  Rig rig({0, 0});
  rig.problem.u[0] = rig.problem.u[1] = -1.5;
  warm_start(&rig.problem, rig.response);
  CHECK(rig.impulse(0) == 1.0);
  CHECK(rig.impulse(1) == 1.0);
}
