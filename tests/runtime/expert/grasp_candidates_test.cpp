#include "runtime/expert/grasp_candidates.h"

#include <numbers>

#include "tests/runtime/expert/fake_table.h"

namespace probe::expert {
namespace {

Footprint footprint(const policy::PrivilegedObject& object) {
  return footprint_of(object.parts, object.pose);
}

GraspProblem bare_problem() {
  GraspProblem problem;
  problem.gripper = test::widowx().hand->shape;
  return problem;
}

TEST_CASE("the top-down pose at yaw 0 is the benchmark's and yaw is read back") {
  Mat3 expected;
  expected << 0, 0, 1, 0, 1, 0, -1, 0, 0;
  CHECK((top_down(Vec3::Zero(), 0).rotation.toRotationMatrix() - expected).norm() < 1e-15);
  for (const double yaw : {-3.0, -1.0, 0.0, 0.4, 2.9}) {
    CHECK(yaw_of(top_down({1, 2, 3}, yaw).rotation) == doctest::Approx(yaw));
  }
}

TEST_CASE("a long object is taken across, near its middle, with the tips above the surface") {
  for (const double turn : {0.0, 30.0, 90.0, 117.0}) {
    CAPTURE(turn);
    const Footprint source = footprint(test::carrot(-0.2, 0.1, turn));
    GraspProblem problem = bare_problem();
    problem.source = &source;
    problem.surface = test::kSurface;
    const auto grasps = grasp_candidates(problem);
    REQUIRE(!grasps.empty());
    const Grasp& best = grasps.front();
    // Fingers' width along the carrot: the yaw is the carrot's, or turned round.
    const double off = std::remainder(best.yaw - turn * std::numbers::pi / 180, std::numbers::pi);
    CHECK(std::abs(off) < 0.01);
    CHECK(best.width < 0.0325);
    CHECK((best.tcp.position.head<2>() - source.center).norm() < 0.012);
    CHECK(best.tcp.position.z() - problem.gripper.tip_below >= test::kSurface + 0.0039);
    CHECK(best.tcp.position.z() + problem.gripper.palm_above > source.top);
    for (std::size_t i = 1; i < grasps.size(); ++i) CHECK(grasps[i - 1].cost <= grasps[i].cost);
  }
}

TEST_CASE("of the two ways round the shorter turn comes first") {
  const Footprint source = footprint(test::carrot(0, 0, 0));
  GraspProblem problem = bare_problem();
  problem.source = &source;
  problem.surface = test::kSurface;
  problem.yaw_now = 3.0;
  CHECK(std::abs(grasp_candidates(problem).front().yaw) > 3.0);
  problem.yaw_now = 0.2;
  CHECK(std::abs(grasp_candidates(problem).front().yaw) < 0.1);
}

TEST_CASE(
    "fingers close on what lies across their middle, not on a bulge that their sides alone meet") {
  // A rounded bar along x. A slab over its end is narrow enough for the fingers everywhere.
  std::vector<Vec3> bar;
  for (const double z : {0.0, 0.026}) {
    for (const double side : {1.0, -1.0}) {
      bar.emplace_back(0.014, side * 0.011, z);
      bar.emplace_back(-0.014, side * 0.011, z);
      bar.emplace_back(side * 0.040, 0.004, z);
      bar.emplace_back(side * 0.040, -0.004, z);
    }
  }
  const Footprint source = footprint(test::object("bar", {bar}, {0, 0, test::kSurface}, 0));
  GraspProblem problem = bare_problem();
  problem.source = &source;
  problem.surface = test::kSurface;
  const auto grasps = grasp_candidates(problem);
  REQUIRE(!grasps.empty());
  for (const Grasp& grasp : grasps) {
    const Vec3 across = grasp.tcp.rotation * Vec3::UnitZ(),
               closing = grasp.tcp.rotation * Vec3::UnitY();
    const Vec2 along(across.x(), across.y()), close(closing.x(), closing.y());
    const Slab line{along, along.dot(grasp.tcp.position.head<2>()), 0.001};
    CAPTURE(grasp.yaw);
    CAPTURE(grasp.off_center);
    CHECK_FALSE(extent_in_slab(source.parts, line, close).empty());
  }
}

TEST_CASE("what is wider than the opening is not gripped") {
  const auto big = test::object("block", {test::block({-0.03, -0.03, 0}, {0.03, 0.03, 0.04})},
                                {0, 0, test::kSurface}, 0);
  const Footprint source = footprint(big);
  GraspProblem problem = bare_problem();
  problem.source = &source;
  problem.surface = test::kSurface;
  CHECK(grasp_candidates(problem).empty());
}

TEST_CASE("a neighbour on the fingers' way makes the grasp move or turn") {
  const Footprint source = footprint(test::object(
      "cube", {test::block({-0.015, -0.015, 0}, {0.015, 0.015, 0.03})}, {0, 0, test::kSurface}, 0));
  const Footprint wall = footprint(test::object(
      "wall", {test::block({-0.05, 0.02, 0}, {0.05, 0.04, 0.03})}, {0, 0, test::kSurface}, 0));
  GraspProblem problem = bare_problem();
  problem.source = &source;
  problem.others = {&wall};
  problem.surface = test::kSurface;
  const auto grasps = grasp_candidates(problem);
  REQUIRE(!grasps.empty());
  CHECK(grasps.front().clearance >= 0.002);
  CHECK(std::abs(std::remainder(grasps.front().yaw - 0.5 * std::numbers::pi, std::numbers::pi)) <
        0.3);
}

TEST_CASE("a wide bowl is taken by its wall, one finger inside") {
  // A square bowl of 12 cm with walls of 1.5 cm, 3 cm high, on a floor of 5 mm.
  const auto bowl = test::object("bowl",
                                 {test::block({-0.06, -0.06, 0}, {0.06, 0.06, 0.005}),
                                  test::block({-0.06, -0.06, 0.005}, {-0.045, 0.06, 0.03}),
                                  test::block({0.045, -0.06, 0.005}, {0.06, 0.06, 0.03}),
                                  test::block({-0.045, -0.06, 0.005}, {0.045, -0.045, 0.03}),
                                  test::block({-0.045, 0.045, 0.005}, {0.045, 0.06, 0.03})},
                                 {0, 0, test::kSurface}, 0);
  const Footprint source = footprint(bowl);
  GraspProblem problem = bare_problem();
  problem.source = &source;
  problem.surface = test::kSurface;
  CHECK(grasp_candidates(problem).empty());
  std::vector<std::vector<Vec3>> parts = bowl.parts;
  for (auto& part : parts) {
    for (Vec3& vertex : part) vertex = bowl.pose.apply(vertex);
  }
  problem.parts = parts;
  const auto grasps = grasp_candidates(problem);
  REQUIRE(!grasps.empty());
  for (const Grasp& grasp : grasps) {
    CHECK(grasp.rim);
    CHECK(grasp.width > 0.0145);
    CHECK(grasp.off_center > 0.045);
    // Fingertips above the floor of the bowl.
    CHECK(grasp.tcp.position.z() - problem.gripper.tip_below > test::kSurface + 0.005);
  }
}

TEST_CASE("where open fingers have no room they are set close to what they take") {
  // Between two walls that open fingers would meet, 42.5 mm out; set ones end 37.5 mm out.
  const Footprint source = footprint(test::object(
      "cube", {test::block({-0.009, -0.05, 0}, {0.009, 0.05, 0.03})}, {0, 0, test::kSurface}, 0));
  std::vector<Footprint> walls;
  for (const double x : {-0.046, 0.046}) {
    walls.push_back(footprint(test::object(
        "wall", {test::block({-0.005, -0.2, 0}, {0.005, 0.2, 0.03})}, {x, 0, test::kSurface}, 0)));
  }
  GraspProblem problem = bare_problem();
  problem.source = &source;
  problem.others = {&walls[0], &walls[1]};
  problem.surface = test::kSurface;
  CHECK(grasp_candidates(problem).empty());
  problem.narrow = true;
  const auto grasps = grasp_candidates(problem);
  REQUIRE(!grasps.empty());
  CHECK(grasps.front().open < 0.9);
  CHECK(grasps.front().open * problem.gripper.opening_half > 0.5 * grasps.front().width + 0.01);
}

TEST_CASE("for an arm that minds how far it is stretched a far hold costs more") {
  const Footprint source = footprint(test::object(
      "bar", {test::block({-0.05, -0.01, 0}, {0.05, 0.01, 0.03})}, {0.7, 0, test::kSurface}, 0));
  GraspProblem problem = bare_problem();
  problem.source = &source;
  problem.surface = test::kSurface;
  const Grasp plain = grasp_candidates(problem).front();
  CHECK(plain.tcp.position.x() == doctest::Approx(0.7));
  problem.minds_stretch = true;
  const Grasp near = grasp_candidates(problem).front();
  CHECK(near.tcp.position.x() == doctest::Approx(0.7));  // rather its middle than 5 mm nearer
  CHECK(near.cost == doctest::Approx(plain.cost + 10 * 0.1));
}

}  // namespace
}  // namespace probe::expert
