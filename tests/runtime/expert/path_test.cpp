#include "runtime/expert/path.h"

#include <array>
#include <cmath>

#include <doctest/doctest.h>

#include "runtime/expert/path_residuals.h"
#include "runtime/policy/policy.h"
#include "tests/runtime/expert/fake_table.h"

namespace probe::expert {
namespace {

robot::Chain widowx() {
  const auto model = robot::load_urdf(test::kUrdf);
  REQUIRE(model.ok());
  auto chain = robot::Chain::create(*model, "ee_gripper_link", test::kArm);
  REQUIRE(chain.ok());
  return *std::move(chain);
}

JointVector home() {
  JointVector q(6);
  q << -0.018, 0.040, 0.222, -0.005, 1.365, 0.002;
  return q;
}

Pose tool_at(const robot::Chain& chain, const JointVector& q) {
  return chain.pose(std::span(q.data(), std::size_t(q.size())));
}

// Ends at `end`, at rest: two steps more there.
void end_at(Residuals& residuals, const robot::Chain& chain, const Path& path, const Pose& end) {
  for (const int step : {path.steps() - 2, path.steps() - 1, path.steps()}) {
    residuals.push_back(via(chain, {step, end, Vec3::Constant(3e3), 1e3}));
  }
}

// A residual that pins the joints at a step.
class Pin final : public Residual {
 public:
  Pin(int step, JointVector value) : Residual({{step, 1}}), value_(std::move(value)) {}
  void evaluate(const JointVector& x, Eigen::VectorXd& r, Eigen::MatrixXd* j) const override {
    r = 1e5 * (x - value_);
    if (j) *j = 1e5 * Eigen::MatrixXd::Identity(x.size(), x.size());
  }

 private:
  JointVector value_;
};

TEST_CASE("between two rests third differences alone give the discrete minimum-jerk quintic") {
  // Sixth differences of the minimiser vanish, so it is the quintic through the six known steps:
  // -2, -1, 0 at one end and n-2, n-1, n at the other.
  constexpr int kSteps = 12;
  const JointVector from = JointVector::Constant(1, 0.3), to = JointVector::Constant(1, 1.1);
  Path path(from, kSteps);
  Residuals residuals;
  for (int k = 1; k <= kSteps; ++k) residuals.push_back(difference(k, 3, 1));
  for (const int k : {kSteps - 2, kSteps - 1, kSteps}) {
    residuals.push_back(std::make_unique<Pin>(k, to));
  }
  const Fit result = fit(path, residuals, {.iterations = 20, .least_gain = 1e-14});
  CHECK(result.converged);
  Eigen::Matrix<double, 6, 6> powers;
  Eigen::Matrix<double, 6, 1> values;
  const std::array<int, 6> known{-2, -1, 0, kSteps - 2, kSteps - 1, kSteps};
  for (int i = 0; i < 6; ++i) {
    for (int p = 0; p < 6; ++p) powers(i, p) = std::pow(known[std::size_t(i)] / 10.0, p);
    values[i] = i < 3 ? 0.3 : 1.1;
  }
  const Eigen::Matrix<double, 6, 1> quintic = powers.fullPivLu().solve(values);
  for (int k = 1; k <= kSteps; ++k) {
    double expected = 0;
    for (int p = 5; p >= 0; --p) expected = expected * (k / 10.0) + quintic[p];
    CHECK(path.at(k)[0] == doctest::Approx(expected).epsilon(1e-6));
  }
}

TEST_CASE("with many steps that is 10 s^3 - 15 s^4 + 6 s^5") {
  constexpr int kSteps = 200;
  Path path(JointVector::Zero(1), kSteps);
  Residuals residuals;
  for (int k = 1; k <= kSteps + 3; ++k) residuals.push_back(difference(k, 3, 1));
  residuals.push_back(std::make_unique<Pin>(kSteps, JointVector::Ones(1)));
  fit(path, residuals, {.iterations = 20, .least_gain = 1e-14});
  for (const double s : {0.25, 0.5, 0.75}) {
    const double expected = s * s * s * (10 + s * (6 * s - 15));
    CHECK(std::abs(path.at(int(s * kSteps))[0] - expected) < 0.02);
  }
}

// Every residual against central differences about random joint positions.
void check_derivative(const Residual& residual, const JointVector& x) {
  Eigen::VectorXd r, up, down;
  Eigen::MatrixXd jacobian;
  residual.evaluate(x, r, &jacobian);
  constexpr double kStep = 1e-6;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    JointVector y = x;
    y[i] += kStep;
    residual.evaluate(y, up, nullptr);
    y[i] -= 2 * kStep;
    residual.evaluate(y, down, nullptr);
    const Eigen::VectorXd slope = (up - down) / (2 * kStep);
    CHECK((slope - jacobian.col(i)).norm() < 1e-4 * (1 + jacobian.col(i).norm()));
  }
}

TEST_CASE("derivatives of all residuals are those of finite differences") {
  const robot::Chain chain = widowx();
  policy::Draws draws(5);
  const std::vector<Ball> balls{{{0.01, 0.03, 0}, 0.01}, {{-0.04, -0.02, 0.02}, 0.02}};
  Obstacles obstacles;
  obstacles.floor = 0.05;
  obstacles.prisms = {make_prism({{0.2, -0.1}, {0.4, -0.1}, {0.4, 0.1}, {0.2, 0.1}}, 0, 0.2)};
  for (int i = 0; i < 50; ++i) {
    JointVector x = home();
    for (double& q : x) q += 0.8 * (draws.uniform() - 0.5);
    Pose wanted = tool_at(chain, home());
    wanted.position += Vec3(0.02, -0.05, 0.01);
    check_derivative(*via(chain, {1, wanted, {10, 20, 30}, 5}), x);
    check_derivative(*upright(chain, 1, 3), x);
    check_derivative(*difference(3, 2, 4), x);
    check_derivative(*joint_limits(chain, 1, 1.2, 3), x);
    check_derivative(*move_limit(1, 0.3, 3), x);
    check_derivative(*clearance(chain, balls, obstacles, {{{1, 1}}, 0.15, 7}), x);
  }
}

TEST_CASE("the tool arrives at a pose smoothly and stays within the limit of moves") {
  const robot::Chain chain = widowx();
  Pose goal = tool_at(chain, home());
  goal.position += Vec3(0.05, 0.12, -0.06);
  constexpr double kMost = 0.05;
  double fastest[2] = {0, 0};
  for (const bool limited : {false, true}) {
    Path path(home(), 10);
    Residuals residuals;
    for (int k = 1; k <= path.steps() + 2; ++k) residuals.push_back(difference(k, 3, 1));
    for (int k = 1; limited && k <= path.steps(); ++k) {
      residuals.push_back(move_limit(k, kMost, 1000));
    }
    end_at(residuals, chain, path, goal);
    CHECK(fit(path, residuals).converged);
    const robot::PoseError left = robot::pose_error(tool_at(chain, path.at(path.steps())), goal);
    CHECK(left.position < 1e-4);
    CHECK(left.rotation < 1e-4);
    for (int k = 1; k <= path.steps(); ++k) {
      fastest[limited] =
          std::max(fastest[limited], (path.at(k) - path.at(k - 1)).cwiseAbs().maxCoeff());
    }
  }
  CHECK(fastest[0] > kMost * 1.02);
  CHECK(fastest[1] < kMost * 1.02);
}

TEST_CASE("a goal beyond a joint's limit is given up at the limit, not passed") {
  const robot::Chain chain = widowx();
  Path path(home(), 10);
  Residuals residuals;
  JointVector goal = home();
  goal[1] = chain.upper()[1] + 0.3;
  for (int k = 1; k <= path.steps() + 2; ++k) residuals.push_back(difference(k, 3, 1));
  for (int k = 1; k <= path.steps(); ++k) residuals.push_back(joint_limits(chain, k, 0.02, 1e4));
  residuals.push_back(via(chain, {path.steps(), tool_at(chain, goal), Vec3::Constant(100), 100}));
  fit(path, residuals);
  double highest = -10;
  for (int k = 1; k <= path.steps(); ++k) highest = std::max(highest, path.at(k)[1]);
  CHECK(highest > chain.upper()[1] - 0.05);
  CHECK(highest < chain.upper()[1]);
}

TEST_CASE("a wall in the way is passed above, and costs nothing where it is not") {
  const robot::Chain chain = widowx();
  const Pose start = tool_at(chain, home());
  Pose goal = start;
  goal.position += Vec3(0, 0.25, 0);
  const std::vector<Ball> balls{{Vec3::Zero(), 0.02}};
  const double margin = 0.01;
  const auto lowest = [&](double wall_top) {
    const Vec2 at = start.position.head<2>() + Vec2(0, 0.125);
    Obstacles obstacles;
    obstacles.prisms = {make_prism({at + Vec2(-0.1, -0.01), at + Vec2(0.1, -0.01),
                                    at + Vec2(0.1, 0.01), at + Vec2(-0.1, 0.01)},
                                   0, wall_top)};
    Path path(home(), 12);
    Residuals residuals;
    for (int k = 1; k <= path.steps() + 2; ++k) residuals.push_back(difference(k, 3, 1));
    for (int k = 1; k <= path.steps(); ++k) {
      residuals.push_back(clearance(chain, balls, obstacles, {{{k, 1}}, margin, 500}));
      residuals.push_back(
          clearance(chain, balls, obstacles, {{{k, 0.5}, {k - 1, 0.5}}, margin, 500}));
    }
    end_at(residuals, chain, path, goal);
    const Fit result = fit(path, residuals, {.iterations = 60});
    CHECK(result.converged);
    double least = 1;
    for (int k = 0; k < 4 * path.steps(); ++k) {
      const double f = 0.25 * (k % 4);
      const JointVector q = (1 - f) * path.at(k / 4) + f * path.at(k / 4 + 1);
      least = std::min(least, least_clearance(tool_at(chain, q), balls, obstacles, 1));
    }
    CHECK(robot::pose_error(tool_at(chain, path.at(path.steps())), goal).position < 1e-4);
    return std::pair(least, result.cost);
  };
  const auto low = lowest(start.position.z() - 0.10), high = lowest(start.position.z() + 0.02);
  CHECK(low.first > margin);
  CHECK(high.first > 0.5 * margin);
  CHECK(high.second > low.second);
}

}  // namespace
}  // namespace probe::expert
