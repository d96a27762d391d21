// The normal equations of least squares over a chain of equal blocks of unknowns, where each
// residual couples only blocks near each other: a symmetric block band, factorised by CHOLMOD.
// Blocks are counted from 0. Nothing here knows what the unknowns mean.
#pragma once

#include <memory>
#include <span>

#include "runtime/base/geometry.h"

namespace probe::expert {

// One block's part in the argument of a residual, which is the sum of factor * block.
struct Share {
  int block = 0;
  double factor = 1;
};

class NormalEquations {
 public:
  // `blocks` of `size` unknowns each; a residual's blocks are at most `band` apart.
  NormalEquations(int blocks, int size, int band);
  ~NormalEquations();
  NormalEquations(NormalEquations&&) noexcept;
  NormalEquations& operator=(NormalEquations&&) noexcept;

  void clear();

  // Adds J^T J and J^T r of residual rows r(x), x = sum of factor * block, J = dr/dx.
  void add(std::span<const Share> shares, const Eigen::MatrixXd& jacobian,
           const Eigen::VectorXd& residual);

  // Solves (H + damping diag(H)) step = -g with H = sum J^T J, g = sum J^T r. False if H is not
  // positive definite. Simplicial factors only: no BLAS, so the same bits on every machine.
  bool solve(double damping, Eigen::VectorXd& step);

  const Eigen::VectorXd& gradient() const;  // g
  Eigen::MatrixXd dense() const;            // H, for tests

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace probe::expert
