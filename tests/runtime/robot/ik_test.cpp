#include "runtime/robot/ik.h"

#include <chrono>

#include "runtime/policy/policy.h"
#include "runtime/robot/rotation.h"
#include "tests/runtime/robot/test_robots.h"

namespace probe::robot {
namespace {

Chain widowx_chain() {
  auto chain = Chain::create(test::widowx(), "ee_gripper_link", test::kArm);
  REQUIRE(chain.ok());
  return std::move(chain).value();
}

std::vector<double> random_q(const Chain& chain, policy::Draws& draws) {
  std::vector<double> q;
  for (std::size_t i = 0; i < chain.joint_count(); ++i) {
    q.push_back(chain.lower()[i] + (chain.upper()[i] - chain.lower()[i]) * draws.uniform());
  }
  return q;
}

bool within_limits(const Chain& chain, const std::vector<double>& q) {
  for (std::size_t i = 0; i < q.size(); ++i) {
    if (q[i] < chain.lower()[i] || q[i] > chain.upper()[i]) return false;
  }
  return true;
}

TEST_CASE("a pose some centimetres and degrees away is found from where the arm is") {
  const Chain chain = widowx_chain();
  policy::Draws draws(11);
  int solved = 0, tried = 0, iterations = 0;
  const auto begin = std::chrono::steady_clock::now();
  for (int i = 0; i < 1000; ++i) {
    std::vector<double> start = random_q(chain, draws), goal = start;
    for (std::size_t j = 0; j < goal.size(); ++j) {
      goal[j] += 0.3 * (2 * draws.uniform() - 1);
      goal[j] = std::min(std::max(goal[j], chain.lower()[j]), chain.upper()[j]);
    }
    const Pose target = chain.pose(goal);
    const IkResult result = solve_ik(chain, target, start);
    ++tried;
    iterations += result.iterations;
    CHECK(within_limits(chain, start));
    const PoseError error = pose_error(chain.pose(start), target);
    CHECK(std::abs(error.position - result.position_error) < 1e-12);
    if (!result.converged) continue;
    ++solved;
    CHECK(error.position <= 1.1e-7);
    CHECK(error.rotation <= 1.1e-7);
  }
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  MESSAGE("solved ", solved, " of ", tried, ", ", double(iterations) / tried, " iterations, ",
          1e6 * seconds / tried, " us each");
  CHECK(solved > 985);  // the rest end at a limit or in a singular pose
}

TEST_CASE("around the table scene's start every reachable pose is found") {
  const Chain chain = widowx_chain();
  policy::Draws draws(12);
  for (int i = 0; i < 1000; ++i) {
    std::vector<double> q(test::kTableStart.begin(), test::kTableStart.begin() + 6);
    Pose target = chain.pose(q);
    target.position +=
        0.06 * (Vec3(draws.uniform(), draws.uniform(), draws.uniform()) * 2 - Vec3::Ones());
    target.rotation =
        from_rotation_vector(
            0.4 * (Vec3(draws.uniform(), draws.uniform(), draws.uniform()) * 2 - Vec3::Ones())) *
        target.rotation;
    CHECK(solve_ik(chain, target, q).converged);
  }
}

TEST_CASE("a pose out of reach does not converge and leaves the nearest positions") {
  const Chain chain = widowx_chain();
  std::vector<double> q(test::kTableStart.begin(), test::kTableStart.begin() + 6);
  Pose target = chain.pose(q);
  target.position.x() += 2;
  const IkResult result = solve_ik(chain, target, q);
  CHECK(!result.converged);
  CHECK(result.position_error > 1);
  CHECK(within_limits(chain, q));
}

TEST_CASE("a start outside the limits is moved to them first") {
  const Chain chain = widowx_chain();
  std::vector<double> q(6, 0);
  const Pose target = chain.pose(q);
  q[1] = 9;
  CHECK(solve_ik(chain, target, q, {.iterations = 0}).converged == false);
  CHECK(q[1] == chain.upper()[1]);
}

TEST_CASE("the same question gets the same bits") {
  const Chain chain = widowx_chain();
  policy::Draws draws(5);
  const std::vector<double> start = random_q(chain, draws);
  const Pose target = chain.pose(random_q(chain, draws));
  std::vector<double> a = start, b = start;
  solve_ik(chain, target, a);
  solve_ik(chain, target, b);
  CHECK(a == b);
}

TEST_CASE("a redundant arm with a continuous joint is solved too") {
  const test::TextFile file(test::panda_like());
  const auto robot = load_urdf(file.path());
  REQUIRE(robot.ok());
  const std::vector<std::string> names = {"joint1", "joint2", "joint3", "joint4",
                                          "joint5", "joint6", "joint7"};
  const auto chain = Chain::create(*robot, "hand", names);
  REQUIRE(chain.ok());
  std::vector<double> goal = {7.0, -0.3, 0.2, -2.0, 0.1, 1.9, 0.8};
  std::vector<double> q = {6.8, -0.1, 0.0, -1.8, 0.0, 1.7, 0.6};
  const Pose target = chain->pose(goal);
  CHECK(solve_ik(*chain, target, q).converged);
  CHECK(std::abs(q[0] - 7.0) < 1);  // no turn undone
}

}  // namespace
}  // namespace probe::robot
