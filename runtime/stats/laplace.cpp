#include "runtime/stats/laplace.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace probe::stats {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

double logistic(double eta) { return 1 / (1 + std::exp(-eta)); }

// log(1 + exp(eta)) without overflow.
double softplus(double eta) { return std::max(eta, 0.0) + std::log1p(std::exp(-std::abs(eta))); }

}  // namespace

LaplaceDeviance::LaplaceDeviance(const MixedData& data, double fixed_prior_sd) : data_(data) {
  if (fixed_prior_sd > 0) precision_ = 1 / (fixed_prior_sd * fixed_prior_sd);
  Index columns = 0;
  for (const auto& levels : data.groups) {
    first_column_.push_back(columns);
    columns += levels.empty()
                   ? 0
                   : 1 + static_cast<Index>(*std::max_element(levels.begin(), levels.end()));
  }
  first_column_.push_back(columns);
  modes_ = VectorXd::Zero(columns);
  scale_ = VectorXd::Zero(columns);
  find_cells();
}

void LaplaceDeviance::find_cells() {
  std::map<std::vector<Index>, std::size_t> known;
  const auto rows = static_cast<std::size_t>(data_.fixed.rows());
  for (std::size_t row = 0; row < rows; ++row) {
    std::vector<Index> columns;
    for (std::size_t f = 0; f < data_.groups.size(); ++f) {
      columns.push_back(first_column_[f] + static_cast<Index>(data_.groups[f][row]));
    }
    const auto [place, is_new] = known.emplace(columns, cells_.size());
    if (is_new) cells_.push_back({std::move(columns)});
    cell_of_row_.push_back(place->second);
  }
}

VectorXd LaplaceDeviance::spread(const VectorXd& by_column) const {
  VectorXd by_cell(static_cast<Index>(cells_.size()));
  for (std::size_t c = 0; c < cells_.size(); ++c) {
    double sum = 0;
    for (const Index column : cells_[c].columns) sum += by_column(column);
    by_cell(static_cast<Index>(c)) = sum;
  }
  VectorXd rows(data_.fixed.rows());
  for (Index row = 0; row < rows.size(); ++row) {
    rows(row) = by_cell(static_cast<Index>(cell_of_row_[static_cast<std::size_t>(row)]));
  }
  return rows;
}

VectorXd LaplaceDeviance::gathered(const VectorXd& by_row) const {
  VectorXd columns = VectorXd::Zero(modes_.size());
  for (Index row = 0; row < by_row.size(); ++row) {
    const Cell& cell = cells_[cell_of_row_[static_cast<std::size_t>(row)]];
    for (const Index column : cell.columns) columns(column) += by_row(row);
  }
  return columns;
}

VectorXd LaplaceDeviance::predictor(const VectorXd& beta, const VectorXd& u) const {
  return data_.fixed * beta + spread(scale_.cwiseProduct(u));
}

// -2 log p(y | u) + u'u.
double LaplaceDeviance::penalised(const VectorXd& eta, const VectorXd& u) const {
  double log_likelihood = 0;
  for (Index row = 0; row < eta.size(); ++row) {
    log_likelihood += data_.successes(row) * eta(row) - data_.trials(row) * softplus(eta(row));
  }
  return -2 * log_likelihood + u.squaredNorm();
}

bool LaplaceDeviance::factorize(const VectorXd& weights) {
  VectorXd by_cell = VectorXd::Zero(static_cast<Index>(cells_.size()));
  for (Index row = 0; row < weights.size(); ++row) {
    by_cell(static_cast<Index>(cell_of_row_[static_cast<std::size_t>(row)])) += weights(row);
  }
  std::vector<Eigen::Triplet<double>> entries;
  for (Index column = 0; column < modes_.size(); ++column)
    entries.emplace_back(column, column, 1.0);
  for (std::size_t c = 0; c < cells_.size(); ++c) {
    const double weight = by_cell(static_cast<Index>(c));
    for (const Index i : cells_[c].columns) {
      for (const Index j : cells_[c].columns) {
        if (i >= j) entries.emplace_back(i, j, weight * scale_(i) * scale_(j));
      }
    }
  }
  Eigen::SparseMatrix<double> a(modes_.size(), modes_.size());
  a.setFromTriplets(entries.begin(), entries.end());
  if (!analyzed_) cholesky_.analyzePattern(a);
  analyzed_ = true;
  cholesky_.factorize(a);
  return cholesky_.info() == Eigen::Success;
}

bool LaplaceDeviance::find_modes(const VectorXd& beta) {
  if (!modes_.allFinite()) modes_.setZero();
  eta_ = predictor(beta, modes_);
  double now = penalised(eta_, modes_);
  if (!std::isfinite(now)) {
    modes_.setZero();
    eta_ = predictor(beta, modes_);
    now = penalised(eta_, modes_);
    if (!std::isfinite(now)) return false;
  }
  for (int iteration = 0; iteration < 100; ++iteration) {
    const VectorXd mu = eta_.unaryExpr(&logistic);
    const VectorXd weights =
        data_.trials.cwiseProduct(mu).cwiseProduct(VectorXd::Ones(mu.size()) - mu);
    if (!factorize(weights)) return false;
    if (modes_.size() == 0) return true;
    const VectorXd residual = data_.successes - data_.trials.cwiseProduct(mu);
    const VectorXd gradient = scale_.cwiseProduct(gathered(residual)) - modes_;
    const VectorXd step = cholesky_.solve(gradient);
    // The squared Newton decrement bounds what is left to gain; below this the next digits are
    // noise.
    if (gradient.dot(step) < 1e-18 * (1 + std::abs(now))) return true;
    double length = 1;
    for (; length > 1e-6; length /= 2) {
      const VectorXd tried = modes_ + length * step;
      const VectorXd eta = predictor(beta, tried);
      const double there = penalised(eta, tried);
      if (there > now + 1e-12 * std::abs(now) || !std::isfinite(there)) continue;
      modes_ = tried;
      eta_ = eta;
      now = there;
      break;
    }
    if (length <= 1e-6) return true;
  }
  return true;
}

// leverage: z' L A^-1 L z by row. trace: sum over rows of w z_f' A^-1 L z, half of what d log
// det(A) has through L itself, by factor.
void LaplaceDeviance::leverages(const VectorXd& weights, VectorXd* leverage,
                                VectorXd* trace_by_factor) {
  const auto cells = static_cast<Index>(cells_.size());
  VectorXd weight_by_cell = VectorXd::Zero(cells);
  for (Index row = 0; row < weights.size(); ++row) {
    weight_by_cell(static_cast<Index>(cell_of_row_[static_cast<std::size_t>(row)])) += weights(row);
  }
  VectorXd by_cell(cells);
  trace_by_factor->setZero(factor_count());
  constexpr Index kBatch = 64;
  for (Index first = 0; first < cells; first += kBatch) {
    const Index count = std::min(kBatch, cells - first);
    Eigen::MatrixXd right = Eigen::MatrixXd::Zero(modes_.size(), count);
    for (Index c = 0; c < count; ++c) {
      for (const Index i : cells_[static_cast<std::size_t>(first + c)].columns)
        right(i, c) += scale_(i);
    }
    const Eigen::MatrixXd solved = cholesky_.solve(right);
    for (Index c = 0; c < count; ++c) {
      const Cell& cell = cells_[static_cast<std::size_t>(first + c)];
      double sum = 0;
      for (std::size_t f = 0; f < cell.columns.size(); ++f) {
        const Index i = cell.columns[f];
        sum += scale_(i) * solved(i, c);
        (*trace_by_factor)(static_cast<Index>(f)) += weight_by_cell(first + c) * solved(i, c);
      }
      by_cell(first + c) = sum;
    }
  }
  leverage->resize(weights.size());
  for (Index row = 0; row < weights.size(); ++row) {
    (*leverage)(row) = by_cell(static_cast<Index>(cell_of_row_[static_cast<std::size_t>(row)]));
  }
}

bool LaplaceDeviance::evaluate(const VectorXd& parameters, double* deviance, VectorXd* gradient) {
  const Index p = fixed_count();
  const Index factors = factor_count();
  const VectorXd beta = parameters.head(p);
  for (Index f = 0; f < factors; ++f) {
    const auto at = static_cast<std::size_t>(f);
    scale_.segment(first_column_[at], first_column_[at + 1] - first_column_[at])
        .setConstant(parameters(p + f));
  }
  if (!parameters.allFinite() || !find_modes(beta)) return false;

  const Index n = eta_.size();
  VectorXd residual(n), weights(n), slope(n);  // slope: d weight / d eta
  for (Index row = 0; row < n; ++row) {
    const double mu = logistic(eta_(row));
    residual(row) = data_.successes(row) - data_.trials(row) * mu;
    weights(row) = data_.trials(row) * mu * (1 - mu);
    slope(row) = weights(row) * (1 - 2 * mu);
  }
  const double log_det = modes_.size() > 0 ? cholesky_.logDeterminant() : 0;
  const double without_prior = penalised(eta_, modes_) + log_det;
  log_likelihood_ = -without_prior / 2;
  // The prior leaves the intercept free.
  VectorXd prior_gradient = 2 * precision_ * beta;
  if (p > 0) prior_gradient(0) = 0;
  *deviance = without_prior + prior_gradient.dot(beta) / 2;
  if (!std::isfinite(*deviance)) return false;

  VectorXd leverage, trace;
  leverages(weights, &leverage, &trace);
  const VectorXd pull = leverage.cwiseProduct(slope);  // d log det / d eta
  VectorXd through_modes = VectorXd::Zero(modes_.size());
  if (modes_.size() > 0)
    through_modes = cholesky_.solve(VectorXd(scale_.cwiseProduct(gathered(pull))));

  gradient->resize(p + factors);
  // The modes answer a change of beta by -A^-1 L Z' W X, and one of a factor's L by
  // A^-1 (E Z' r - L Z' W Z E u), E the factor's columns.
  const VectorXd answered = weights.cwiseProduct(spread(scale_.cwiseProduct(through_modes)));
  gradient->head(p) = data_.fixed.transpose() * (pull - 2 * residual - answered) + prior_gradient;
  const VectorXd residual_by_column = gathered(residual);
  for (Index f = 0; f < factors; ++f) {
    const Index first = first_column_[static_cast<std::size_t>(f)];
    const Index size = first_column_[static_cast<std::size_t>(f) + 1] - first;
    VectorXd only = VectorXd::Zero(modes_.size());
    only.segment(first, size) = modes_.segment(first, size);
    const VectorXd direct = spread(only);
    (*gradient)(p + f) =
        (pull - 2 * residual - answered).dot(direct) + 2 * trace(f) +
        through_modes.segment(first, size).dot(residual_by_column.segment(first, size));
  }
  return gradient->allFinite();
}

std::vector<VectorXd> LaplaceDeviance::modes() const {
  std::vector<VectorXd> by_factor;
  const VectorXd scaled = scale_.cwiseProduct(modes_);
  for (std::size_t f = 0; f + 1 < first_column_.size(); ++f) {
    by_factor.push_back(scaled.segment(first_column_[f], first_column_[f + 1] - first_column_[f]));
  }
  return by_factor;
}

}  // namespace probe::stats
