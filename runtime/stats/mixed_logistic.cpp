#include "runtime/stats/mixed_logistic.h"

#include <cmath>
#include <string>

#include "runtime/stats/laplace.h"

namespace probe::stats {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

Failure failed(const std::string& message) { return {Fault::kStats, message, ""}; }

Status check(const MixedData& data) {
  const Index n = data.fixed.rows();
  if (n == 0 || data.fixed.cols() == 0)
    return failed("a mixed model needs rows and a fixed effect");
  if (data.successes.size() != n || data.trials.size() != n) {
    return failed("successes and trials do not have one number a row");
  }
  if (!data.fixed.allFinite()) return failed("a covariate is not finite");
  for (Index i = 0; i < n; ++i) {
    if (!(data.successes(i) >= 0 && data.successes(i) <= data.trials(i))) {
      return failed("row " + std::to_string(i) + ": successes do not lie in 0..trials");
    }
  }
  for (const auto& levels : data.groups) {
    if (static_cast<Index>(levels.size()) != n)
      return failed("a factor does not have one level a row");
  }
  if (Eigen::ColPivHouseholderQR<MatrixXd>(data.fixed).rank() < data.fixed.cols()) {
    return failed("the columns of the fixed effects depend on each other");
  }
  return {};
}

// Quasi-Newton (BFGS) minimisation with backtracking; the inverse Hessian is kept.
class Search {
 public:
  Search(LaplaceDeviance& deviance, VectorXd start, MatrixXd inverse_hessian)
      : deviance_(deviance), at_(std::move(start)), inverse_(std::move(inverse_hessian)) {}

  Result<int> run() {
    if (!deviance_.evaluate(at_, &value_, &gradient_)) return failed("the start overflows");
    for (int iteration = 1; iteration <= kIterations; ++iteration) {
      if (gradient_.cwiseAbs().maxCoeff() < kGradient) return iteration;
      VectorXd step = -(inverse_ * gradient_);
      if (gradient_.dot(step) >= 0) {
        inverse_.setIdentity();
        step = -gradient_;
      }
      const double longest = step.cwiseAbs().maxCoeff();
      if (longest > kLongestStep) step *= kLongestStep / longest;
      if (!move_along(step)) {
        // No way down: at the bottom as far as the numbers tell, or stuck on a wrong curvature.
        if (gradient_.cwiseAbs().maxCoeff() < kFlat) return iteration;
        if (inverse_.isIdentity()) return failed("the search does not settle");
        inverse_.setIdentity();
      }
      if (at_.cwiseAbs().maxCoeff() > kSeparated) {
        return failed(
            "an effect grows without end: the fixed effects separate successes from failures; use "
            "a prior");
      }
    }
    return failed("the search does not settle in " + std::to_string(kIterations) + " steps");
  }

  const VectorXd& at() const { return at_; }

 private:
  static constexpr int kIterations = 500;
  static constexpr double kGradient = 1e-6;  // deviance per unit of log-odds
  static constexpr double kFlat = 1e-3;      // what rounding of the deviance hides
  static constexpr double kLongestStep = 2;  // log-odds
  static constexpr double kSeparated = 25;   // log-odds no finite sample supports

  bool move_along(const VectorXd& step) {
    const double slope = gradient_.dot(step);
    for (double length = 1; length > 1e-10; length /= 2) {
      const VectorXd tried = at_ + length * step;
      double value = 0;
      VectorXd gradient;
      if (!deviance_.evaluate(tried, &value, &gradient)) continue;
      if (value > value_ + 1e-4 * length * slope) continue;
      update(tried - at_, gradient - gradient_);
      at_ = tried;
      value_ = value;
      gradient_ = gradient;
      return true;
    }
    return false;
  }

  void update(const VectorXd& s, const VectorXd& y) {
    const double curvature = s.dot(y);
    if (curvature <= 1e-12 * s.norm() * y.norm()) return;
    const double rho = 1 / curvature;
    const MatrixXd left = MatrixXd::Identity(s.size(), s.size()) - rho * s * y.transpose();
    inverse_ = left * inverse_ * left.transpose() + rho * s * s.transpose();
  }

  LaplaceDeviance& deviance_;
  VectorXd at_;
  MatrixXd inverse_;
  double value_ = 0;
  VectorXd gradient_;
};

// Effects of the model without random intercepts, by a few lightly damped Newton steps: only a
// start.
VectorXd plain_logistic(const MixedData& data, MatrixXd* inverse_information) {
  const Index p = data.fixed.cols();
  VectorXd beta = VectorXd::Zero(p);
  for (int iteration = 0; iteration < 6; ++iteration) {
    const VectorXd eta = data.fixed * beta;
    const VectorXd mu = eta.unaryExpr([](double e) { return 1 / (1 + std::exp(-e)); });
    const VectorXd weights =
        data.trials.cwiseProduct(mu).cwiseProduct(VectorXd::Ones(mu.size()) - mu);
    MatrixXd information = data.fixed.transpose() * weights.asDiagonal() * data.fixed;
    information.diagonal().array() += 0.1;
    *inverse_information = information.inverse();
    const VectorXd score =
        data.fixed.transpose() * (data.successes - data.trials.cwiseProduct(mu)) - 0.1 * beta;
    beta += *inverse_information * score;
  }
  return beta;
}

// Covariance 2 H^-1 of the deviance's Hessian H, by central differences of its exact gradient; the
// random part is left out where its standard deviation is 0 and the Hessian flat.
Result<MatrixXd> covariance(LaplaceDeviance& deviance, const VectorXd& at) {
  const Index size = at.size();
  MatrixXd hessian(size, size);
  for (Index j = 0; j < size; ++j) {
    constexpr double kStep = 1e-4;
    VectorXd there = at;
    VectorXd above, below;
    double value = 0;
    there(j) = at(j) + kStep;
    if (!deviance.evaluate(there, &value, &above)) return failed("the curvature overflows");
    there(j) = at(j) - kStep;
    if (!deviance.evaluate(there, &value, &below)) return failed("the curvature overflows");
    hessian.col(j) = (above - below) / (2 * kStep);
  }
  hessian = ((hessian + hessian.transpose()) / 2).eval();
  const Eigen::LDLT<MatrixXd> factor(hessian);
  if (factor.isPositive() && factor.vectorD().minCoeff() > 0)
    return MatrixXd(2 * hessian.inverse());
  const Index p = deviance.fixed_count();
  return MatrixXd(2 * hessian.topLeftCorner(p, p).inverse());
}

}  // namespace

Result<MixedFit> fit_mixed_logistic(const MixedData& data, const MixedOptions& options) {
  PROBE_TRY(check(data));
  LaplaceDeviance deviance(data, options.fixed_prior_sd);
  const Index p = deviance.fixed_count();
  const Index factors = deviance.factor_count();
  MatrixXd information_inverse;
  VectorXd start(p + factors);
  start.head(p) = plain_logistic(data, &information_inverse);
  start.tail(factors).setConstant(0.7);
  MatrixXd inverse_hessian = MatrixXd::Identity(p + factors, p + factors) * 0.05;
  inverse_hessian.topLeftCorner(p, p) = information_inverse / 2;

  Search search(deviance, start, inverse_hessian);
  PROBE_ASSIGN(const int iterations, search.run());
  MixedFit fit;
  fit.iterations = iterations;
  PROBE_ASSIGN(const MatrixXd full, covariance(deviance, search.at()));
  fit.covariance = full.topLeftCorner(p, p);
  double value = 0;
  VectorXd gradient;
  if (!deviance.evaluate(search.at(), &value, &gradient)) return failed("the optimum overflows");
  fit.fixed = search.at().head(p);
  fit.random_sd = search.at().tail(factors).cwiseAbs();
  fit.modes = deviance.modes();
  fit.log_likelihood = deviance.log_likelihood();
  return fit;
}

}  // namespace probe::stats
