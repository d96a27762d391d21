// Mixed-effects logistic regression: fixed effects (policy, category, axis) with crossed or nested
// random intercepts (task, object, start). Knows nothing of runs; a caller makes the table.
#pragma once

#include <Eigen/Dense>
#include <cstdint>
#include <vector>

#include "runtime/base/result.h"

namespace probe::stats {

// n rows: `successes[i]` of `trials[i]` episodes with fixed covariates `fixed.row(i)` (the
// intercept is a column of ones that the caller gives) and, for each grouping factor f, the level
// groups[f][i], counted from 0.
struct MixedData {
  Eigen::MatrixXd fixed;      // n x p
  Eigen::VectorXd successes;  // n
  Eigen::VectorXd trials;     // n
  std::vector<std::vector<std::uint32_t>> groups;
};

struct MixedOptions {
  // Standard deviation of a normal prior on every fixed effect but the first column, log-odds; 0
  // for none. A policy that never succeeds has no finite effect without one.
  double fixed_prior_sd = 0;
};

struct MixedFit {
  Eigen::VectorXd fixed;               // p, log-odds
  Eigen::MatrixXd covariance;          // p x p, of the fixed effects, from the full Hessian
  Eigen::VectorXd random_sd;           // one per factor, log-odds; 0 where the data show none
  std::vector<Eigen::VectorXd> modes;  // the random intercepts, a vector a factor
  double log_likelihood = 0;           // Laplace, without the binomial coefficients
  int evaluations = 0;                 // of the deviance
};

// Maximum likelihood with the Laplace approximation, as lme4's glmer (Bates et al. 2015, J.
// Statist. Software 67:1): penalised iteratively reweighted least squares for the modes of the
// random effects by sparse Cholesky factors (CHOLMOD) inside NLopt's quasi-Newton search over
// effects and standard deviations, with exact gradients. Fails (kStats) on sizes that do not agree,
// columns that depend on each other, outcomes that fixed effects separate without a prior, or a
// search that does not settle.
Result<MixedFit> fit_mixed_logistic(const MixedData& data, const MixedOptions& options = {});

}  // namespace probe::stats
