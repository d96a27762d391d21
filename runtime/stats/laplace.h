// The Laplace-approximated deviance of a mixed logistic model and its exact gradient. A part of
// mixed_logistic; knows nothing of the search.
#pragma once

#include <Eigen/CholmodSupport>
#include <Eigen/Dense>
#include <Eigen/Sparse>
#include <cstdint>
#include <vector>

#include "runtime/stats/mixed_logistic.h"

namespace probe::stats {

// The model's linear predictor is X beta + Z L u, with u standard normal and L diagonal with the
// factor's standard deviation. For the modes u of the penalised likelihood,
//   deviance = -2 log p(y | u) + u'u + log det(A),   A = L Z' W Z L + I,
// with W the binomial weights (Bates et al. 2015, eqs. 28-35). A deviance is even in every standard
// deviation, so the search may pass through 0 and reads the sign as nothing.
class LaplaceDeviance {
 public:
  LaplaceDeviance(const MixedData& data, double fixed_prior_sd);

  Eigen::Index fixed_count() const { return data_.fixed.cols(); }
  Eigen::Index factor_count() const { return static_cast<Eigen::Index>(data_.groups.size()); }

  // Deviance (with the prior's penalty) at parameters (beta, sd); its gradient into `gradient`.
  // False where the modes could not be found (a number overflowed).
  bool evaluate(const Eigen::VectorXd& parameters, double* deviance, Eigen::VectorXd* gradient);

  // At the parameters evaluated last.
  double log_likelihood() const { return log_likelihood_; }
  std::vector<Eigen::VectorXd> modes() const;

 private:
  // Rows with the same levels in every factor share their columns of Z: a cell.
  struct Cell {
    std::vector<Eigen::Index> columns;  // of Z, one a factor
  };

  void find_cells();
  Eigen::VectorXd predictor(const Eigen::VectorXd& beta, const Eigen::VectorXd& u) const;
  double penalised(const Eigen::VectorXd& eta, const Eigen::VectorXd& u) const;
  Eigen::VectorXd spread(const Eigen::VectorXd& by_column) const;  // Z v, by row
  Eigen::VectorXd gathered(const Eigen::VectorXd& by_row) const;   // Z' v, by column
  bool find_modes(const Eigen::VectorXd& beta);
  bool factorize(const Eigen::VectorXd& weights);
  void leverages(const Eigen::VectorXd& weights, Eigen::VectorXd* leverage,
                 Eigen::VectorXd* trace_by_factor);

  const MixedData& data_;
  double precision_ = 0;                    // of the fixed effects' prior
  std::vector<Eigen::Index> first_column_;  // of Z, a factor; and the end
  std::vector<Cell> cells_;
  std::vector<std::size_t> cell_of_row_;
  Eigen::VectorXd scale_;  // L, by column of Z
  Eigen::VectorXd modes_;
  Eigen::VectorXd eta_;
  double log_likelihood_ = 0;
  bool analyzed_ = false;
  Eigen::CholmodSimplicialLLT<Eigen::SparseMatrix<double>> cholesky_;
};

}  // namespace probe::stats
