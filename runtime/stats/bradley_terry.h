// Ranks policies by who beat whom on shared starts.
#pragma once

#include <Eigen/Dense>

#include "runtime/base/result.h"

namespace probe::stats {

// Log-strengths that sum to 0 and their standard errors (delta method, the same constraint).
struct Ranking {
  Eigen::VectorXd strength;
  Eigen::VectorXd standard_error;
};

// Bradley and Terry's model (Biometrika 1952, 39:324), P(i beats j) = logistic(s_i - s_j), by
// Newton's method. wins(i, j): how often i did better than j (n x n, no negative entries; count a
// tie as half a win for both). Policies that met get `prior_wins` more wins each way, so that one
// that never lost has a finite strength; 0 gives the maximum likelihood. Fails (kUsage) when
// some policies are not linked by any chain of comparisons, or without a prior by chains of wins
// both ways.
Result<Ranking> bradley_terry(const Eigen::MatrixXd& wins, double prior_wins = 0.5);

}  // namespace probe::stats
