#include "runtime/expert/normal_equations.h"

#include <array>

#include <doctest/doctest.h>

#include "runtime/policy/policy.h"

namespace probe::expert {
namespace {

// A residual between blocks `a` and `b` with random rows, entered in both ways.
struct Random {
  policy::Draws draws{7};
  Eigen::MatrixXd matrix(int rows, int columns) {
    Eigen::MatrixXd m(rows, columns);
    for (double& x : m.reshaped()) x = 2 * draws.uniform() - 1;
    return m;
  }
};

TEST_CASE("a block band solves what the dense normal equations solve") {
  constexpr int kBlocks = 7, kSize = 3, kBand = 2;
  Random random;
  NormalEquations equations(kBlocks, kSize, kBand);
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(kBlocks * kSize, kBlocks * kSize);
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(kBlocks * kSize);
  for (int b = 0; b < kBlocks; ++b) {
    for (int apart = 0; apart <= kBand && b + apart < kBlocks; ++apart) {
      const Eigen::MatrixXd j = random.matrix(4, kSize);
      const Eigen::VectorXd r = random.matrix(4, 1);
      const std::array<Share, 2> shares{Share{b + apart, 0.5}, Share{b, -1.5}};
      equations.add(std::span(shares).first(apart == 0 ? 1 : 2), j, r);
      Eigen::MatrixXd row = Eigen::MatrixXd::Zero(4, kBlocks * kSize);
      row.middleCols((b + apart) * kSize, kSize) += 0.5 * j;
      if (apart > 0) row.middleCols(b * kSize, kSize) -= 1.5 * j;
      dense += row.transpose() * row;
      gradient += row.transpose() * r;
    }
  }
  CHECK((equations.dense() - dense).norm() < 1e-12);
  CHECK((equations.gradient() - gradient).norm() < 1e-12);
  for (const double damping : {0.0, 0.3}) {
    Eigen::VectorXd step;
    REQUIRE(equations.solve(damping, step));
    Eigen::MatrixXd damped = dense;
    damped.diagonal() *= 1 + damping;
    CHECK((damped * step + gradient).norm() < 1e-10);
  }
  equations.clear();
  CHECK(equations.dense().norm() == 0);
}

TEST_CASE("equations that leave an unknown open are not solved") {
  NormalEquations equations(2, 1, 1);
  const std::array<Share, 1> first{Share{0, 1}};
  equations.add(first, Eigen::MatrixXd::Ones(1, 1), Eigen::VectorXd::Ones(1));
  Eigen::VectorXd step;
  CHECK(!equations.solve(0, step));
}

}  // namespace
}  // namespace probe::expert
