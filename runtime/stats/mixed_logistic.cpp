#include "runtime/stats/mixed_logistic.h"

#include <nlopt.h>

#include <cmath>
#include <memory>
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

constexpr int kEvaluations = 1000;  // at most; two dozen are usual
constexpr double kGain = 1e-13;     // of the deviance; a step that gains less is the last
constexpr double kFlat = 1e-3;      // deviance per unit of log-odds: what its rounding hides
constexpr double kBound = 30;       // log-odds searched to either side
constexpr double kSeparated = 15;   // log-odds that no sample of less than a million supports

struct Question {
  LaplaceDeviance& deviance;
  int evaluations = 0;
};

// As nlopt_func: `question` is a Question.
double deviance_at(unsigned size, const double* at, double* gradient, void* question) {
  Question& asked = *static_cast<Question*>(question);
  ++asked.evaluations;
  const VectorXd parameters = Eigen::Map<const VectorXd>(at, size);
  double value = 0;
  VectorXd slope;
  if (!asked.deviance.evaluate(parameters, &value, &slope)) {
    value = HUGE_VAL;
    slope.setZero(parameters.size());
  }
  if (gradient != nullptr) Eigen::Map<VectorXd>(gradient, size) = slope;
  return value;
}

// NLopt's limited-memory BFGS (Nocedal 1980; Luksan's code) from `at` to the least deviance, into
// `at`. One thread and no BLAS: the same bits in every run. Returns the evaluations it took.
Result<int> minimise(LaplaceDeviance& deviance, VectorXd* at) {
  Question question{deviance};
  const auto size = static_cast<unsigned>(at->size());
  const std::unique_ptr<nlopt_opt_s, decltype(&nlopt_destroy)> search(
      nlopt_create(NLOPT_LD_LBFGS, size), &nlopt_destroy);
  if (!search) return failed("no memory for the search");
  nlopt_set_min_objective(search.get(), deviance_at, &question);
  nlopt_set_lower_bounds1(search.get(), -kBound);
  nlopt_set_upper_bounds1(search.get(), kBound);
  nlopt_set_ftol_rel(search.get(), kGain);
  nlopt_set_maxeval(search.get(), kEvaluations);
  double value = 0;
  nlopt_optimize(search.get(), at->data(), &value);
  // How it ended says less than where: rounding stops a search at its very end, too.
  if (at->cwiseAbs().maxCoeff() > kSeparated) {
    return failed(
        "an effect grows without end: the fixed effects separate successes from failures; use a "
        "prior");
  }
  VectorXd gradient;
  if (!deviance.evaluate(*at, &value, &gradient)) return failed("the optimum overflows");
  if (gradient.cwiseAbs().maxCoeff() < kFlat) return question.evaluations;
  return failed("the search does not settle in " + std::to_string(kEvaluations) + " steps");
}

// Effects of the model without random intercepts, by a few lightly damped Newton steps: only a
// start.
VectorXd plain_logistic(const MixedData& data) {
  const Index p = data.fixed.cols();
  VectorXd beta = VectorXd::Zero(p);
  for (int iteration = 0; iteration < 6; ++iteration) {
    const VectorXd eta = data.fixed * beta;
    const VectorXd mu = eta.unaryExpr([](double e) { return 1 / (1 + std::exp(-e)); });
    const VectorXd weights =
        data.trials.cwiseProduct(mu).cwiseProduct(VectorXd::Ones(mu.size()) - mu);
    MatrixXd information = data.fixed.transpose() * weights.asDiagonal() * data.fixed;
    information.diagonal().array() += 0.1;
    const VectorXd score =
        data.fixed.transpose() * (data.successes - data.trials.cwiseProduct(mu)) - 0.1 * beta;
    beta += information.ldlt().solve(score);
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
  VectorXd at(p + factors);
  at.head(p) = plain_logistic(data);
  at.tail(factors).setConstant(0.7);
  MixedFit fit;
  PROBE_ASSIGN(fit.evaluations, minimise(deviance, &at));
  PROBE_ASSIGN(const MatrixXd full, covariance(deviance, at));
  fit.covariance = full.topLeftCorner(p, p);
  double value = 0;
  VectorXd gradient;
  if (!deviance.evaluate(at, &value, &gradient)) return failed("the optimum overflows");
  fit.fixed = at.head(p);
  fit.random_sd = at.tail(factors).cwiseAbs();
  fit.modes = deviance.modes();
  fit.log_likelihood = deviance.log_likelihood();
  return fit;
}

}  // namespace probe::stats
