#include "runtime/stats/bradley_terry.h"

#include <cmath>
#include <utility>
#include <vector>

namespace probe::stats {
namespace {

// Which policies `from` reaches over entries of `wins` above 0, along rows or along columns.
std::vector<bool> reached(const Eigen::MatrixXd& wins, Eigen::Index from, bool along_rows) {
  std::vector<bool> seen(static_cast<std::size_t>(wins.rows()), false);
  std::vector<Eigen::Index> open{from};
  seen[static_cast<std::size_t>(from)] = true;
  while (!open.empty()) {
    const Eigen::Index i = open.back();
    open.pop_back();
    for (Eigen::Index j = 0; j < wins.rows(); ++j) {
      const double w = along_rows ? wins(i, j) : wins(j, i);
      if (w <= 0 || seen[static_cast<std::size_t>(j)]) continue;
      seen[static_cast<std::size_t>(j)] = true;
      open.push_back(j);
    }
  }
  return seen;
}

// The maximum exists exactly when everybody beats everybody along some chain (Ford 1957).
bool has_maximum(const Eigen::MatrixXd& wins) {
  for (const bool along_rows : {true, false}) {
    for (const bool seen : reached(wins, 0, along_rows)) {
      if (!seen) return false;
    }
  }
  return true;
}

}  // namespace

Result<Ranking> bradley_terry(const Eigen::MatrixXd& wins, double prior_wins) {
  const Eigen::Index n = wins.rows();
  if (n < 2 || wins.cols() != n || !wins.allFinite() || wins.minCoeff() < 0) {
    return Failure{Fault::kUsage,
                   "a ranking needs a square table of wins, none negative, of two or more", ""};
  }
  Eigen::MatrixXd w = wins;
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j) {
      if (i == j) {
        w(i, j) = 0;
      } else if (wins(i, j) + wins(j, i) > 0) {
        w(i, j) += prior_wins;
      }
    }
  }
  if (!has_maximum(w)) {
    return Failure{Fault::kUsage,
                   "some policies are not linked by comparisons, so they cannot be ranked", ""};
  }
  Ranking ranking{Eigen::VectorXd::Zero(n), Eigen::VectorXd::Zero(n)};
  // The information matrix has the constant vector as its null space; adding ones/n makes the
  // sum-to-zero solution the unique one, and its inverse less ones/n the pseudo-inverse.
  const Eigen::MatrixXd ones = Eigen::MatrixXd::Constant(n, n, 1.0 / static_cast<double>(n));
  Eigen::MatrixXd information(n, n);
  for (int iteration = 0; iteration < 100; ++iteration) {
    Eigen::VectorXd gradient = Eigen::VectorXd::Zero(n);
    information.setZero();
    for (Eigen::Index i = 0; i < n; ++i) {
      for (Eigen::Index j = i + 1; j < n; ++j) {
        const double games = w(i, j) + w(j, i);
        if (games <= 0) continue;
        const double p = 1 / (1 + std::exp(ranking.strength(j) - ranking.strength(i)));
        const double surplus = w(i, j) - games * p;
        const double weight = games * p * (1 - p);
        gradient(i) += surplus;
        gradient(j) -= surplus;
        information(i, i) += weight;
        information(j, j) += weight;
        information(i, j) -= weight;
        information(j, i) -= weight;
      }
    }
    Eigen::VectorXd step = (information + ones).ldlt().solve(gradient);
    // A step of more than one unit of log-odds is cut: the likelihood is concave but not quadratic.
    const double longest = step.cwiseAbs().maxCoeff();
    if (longest > 1) step /= longest;
    ranking.strength += step;
    if (longest < 1e-12) break;
  }
  const Eigen::MatrixXd covariance = (information + ones).inverse() - ones;
  ranking.standard_error = covariance.diagonal().cwiseSqrt();
  return ranking;
}

}  // namespace probe::stats
