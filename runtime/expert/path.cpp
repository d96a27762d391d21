// Damping as in Marquardt (1963), on the diagonal of the normal equations.
#include "runtime/expert/path.h"

#include <algorithm>
#include <cmath>

#include "runtime/base/check.h"

namespace probe::expert {
namespace {

constexpr int kFarthest = 3;  // blocks that a residual couples: third differences
constexpr double kFirstDamping = 1e-4, kMostDamping = 1e6;  // times the diagonal of J^T J

// Cost at the path; fills the equations.
double linearise(const Path& path, const Residuals& residuals, NormalEquations& equations) {
  equations.clear();
  double cost = 0;
  Eigen::VectorXd r;
  Eigen::MatrixXd jacobian;
  std::vector<Share> shares;
  for (const auto& residual : residuals) {
    residual->evaluate(combined(path, residual->shares()), r, &jacobian);
    const double square = r.squaredNorm();
    if (square == 0 && jacobian.isZero(0)) continue;  // an inequality that holds
    cost += 0.5 * square;
    shares.clear();
    for (const StepShare& s : residual->shares()) {
      if (s.step <= 0) continue;
      const int block = std::min(s.step, path.steps()) - 1;
      const auto same = std::find_if(shares.begin(), shares.end(),
                                     [&](const Share& other) { return other.block == block; });
      if (same == shares.end()) {
        shares.push_back({block, s.factor});
      } else {
        same->factor += s.factor;
      }
    }
    if (!shares.empty()) equations.add(shares, jacobian, r);
  }
  return cost;
}

}  // namespace

Path::Path(const JointVector& start, int steps)
    : past_(start.replicate(1, kPast)), steps_(start.replicate(1, steps)) {
  PROBE_CHECK(steps > 0 && start.size() > 0, "a path has steps and joints");
}

JointVector Path::at(int step) const {
  if (step <= 0) return past_.col(std::max(step + kPast - 1, 0));
  return steps_.col(std::min(step, steps()) - 1);
}

void Path::set(int step, const JointVector& q) {
  PROBE_CHECK(step > -kPast && step <= steps(), "the step is one of the path's");
  if (step <= 0) {
    past_.col(step + kPast - 1) = q;
  } else {
    steps_.col(step - 1) = q;
  }
}

JointVector combined(const Path& path, std::span<const StepShare> shares) {
  JointVector x = JointVector::Zero(path.joints());
  for (const StepShare& s : shares) x += s.factor * path.at(s.step);
  return x;
}

Fit fit(Path& path, const Residuals& residuals, const FitOptions& options) {
  const int band = std::min(kFarthest, path.steps() - 1);
  NormalEquations now(path.steps(), path.joints(), band), next(path.steps(), path.joints(), band);
  Fit out;
  out.cost = linearise(path, residuals, now);
  double damping = kFirstDamping;
  Eigen::VectorXd step;
  while (out.iterations < options.iterations && !out.converged && damping < kMostDamping) {
    ++out.iterations;
    if (!now.solve(damping, step)) {
      damping = std::max(10 * damping, 1e-8);
      continue;
    }
    Path tried = path;
    tried.unknowns().reshaped() += step;
    const double cost = linearise(tried, residuals, next);
    if (!(cost < out.cost)) {
      // No room below, within rounding: this is the minimum.
      if (cost <= out.cost * (1 + 1e-12)) out.converged = true;
      damping = std::max(8 * damping, 1e-8);
      continue;
    }
    out.converged = out.cost - cost <= options.least_gain * out.cost;
    out.cost = cost;
    path = std::move(tried);
    std::swap(now, next);
    damping *= 0.2;
  }
  return out;
}

}  // namespace probe::expert
