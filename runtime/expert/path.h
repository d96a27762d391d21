// A path: the joint positions at the control steps to come, and the least squares that shape it.
// Steps are counted from the present one, 0; what was before is known and past the last the arm
// stands still. Every residual looks at one linear combination of steps.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "runtime/base/geometry.h"
#include "runtime/expert/normal_equations.h"
#include "runtime/robot/kinematics.h"

namespace probe::expert {

using JointVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, robot::kMaxChainJoints, 1>;

inline std::span<const double> span_of(const JointVector& q) {
  return {q.data(), static_cast<std::size_t>(q.size())};
}

class Path {
 public:
  static constexpr int kPast = 3;  // steps -2, -1 and 0 are known

  // All steps at `start`, at rest before.
  Path(const JointVector& start, int steps);

  int steps() const { return static_cast<int>(steps_.cols()); }
  int joints() const { return static_cast<int>(steps_.rows()); }

  // Any step: those before -2 are -2, those after the last are the last.
  JointVector at(int step) const;
  void set(int step, const JointVector& q);  // from -2 to the last

  // All unknown steps, one column each.
  const Eigen::MatrixXd& unknowns() const { return steps_; }
  Eigen::MatrixXd& unknowns() { return steps_; }

 private:
  Eigen::MatrixXd past_, steps_;
};

// A step's part in the argument of a residual; known steps are allowed.
struct StepShare {
  int step = 0;
  double factor = 1;
};

// Rows r(x) of the sum of squares, x = sum of factor * joint positions at the steps.
class Residual {
 public:
  explicit Residual(std::vector<StepShare> shares) : shares_(std::move(shares)) {}
  virtual ~Residual() = default;
  const std::vector<StepShare>& shares() const { return shares_; }

  // Resizes and fills r and, unless null, its derivative by x.
  virtual void evaluate(const JointVector& x, Eigen::VectorXd& r,
                        Eigen::MatrixXd* jacobian) const = 0;

 private:
  std::vector<StepShare> shares_;
};
using Residuals = std::vector<std::unique_ptr<Residual>>;

struct Fit {
  double cost = 0;  // half the sum of squares
  int iterations = 0;
  bool converged = false;
};

struct FitOptions {
  int iterations = 30;
  double least_gain = 1e-3;  // of the cost; a step that gains less is the last
};

// Levenberg-Marquardt on the path's unknown steps.
Fit fit(Path& path, const Residuals& residuals, const FitOptions& options = {});

// The sum of factor * step.
JointVector combined(const Path& path, std::span<const StepShare> shares);

}  // namespace probe::expert
