// Damped steps on the pose error; a joint that a step would push through its limit is held there
// and the step redone.
#include "runtime/robot/ik.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "runtime/base/check.h"
#include "runtime/robot/rotation.h"

namespace probe::robot {
namespace {

constexpr double kLargestStep = 0.5;  // rad or m an iteration; the linear model is poor beyond

using Vec6 = Eigen::Matrix<double, 6, 1>;
using Joints = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxChainJoints, 1>;
using Normal =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxChainJoints, kMaxChainJoints>;

// Error and its linear model at one q; rotation rows scaled by the lever.
struct Model {
  Vec6 error;
  Jacobian jacobian;
  double cost = 0;            // |error|^2
  double rotation_error = 0;  // rad

  void evaluate(const Chain& chain, const Pose& target, std::span<const double> q, double lever) {
    const Pose now = chain.pose(q, jacobian);
    error.head<3>() = target.position - now.position;
    error.tail<3>() = lever * to_rotation_vector(target.rotation * now.rotation.conjugate());
    jacobian.bottomRows<3>() *= lever;
    cost = error.squaredNorm();
    rotation_error = lever > 0 ? error.tail<3>().norm() / lever : 0;
  }
  double position_error() const { return error.head<3>().norm(); }
};

class Solver {
 public:
  Solver(const Chain& chain, const Pose& target, std::span<double> q, double lever)
      : chain_(chain), target_(target), q_(q), lever_(lever) {
    for (std::size_t i = 0; i < q.size(); ++i) {
      q_[i] = std::clamp(q_[i], chain.lower()[i], chain.upper()[i]);
    }
    now_.evaluate(chain_, target_, q_, lever_);
  }

  IkResult run(const IkOptions& options) {
    double damping = 1e-3;  // times the cost: wide steps when far, Gauss-Newton at the end
    int i = 0;
    for (; i < options.iterations && !done(options); ++i) {
      if (damping > 1e9) break;  // no step helps: a minimum that is not the pose
      const Joints step = bounded_step(damping * now_.cost + 1e-14);
      std::array<double, kMaxChainJoints> tried{};
      for (std::size_t j = 0; j < q_.size(); ++j) {
        tried[j] = std::clamp(q_[j] + step[Eigen::Index(j)], chain_.lower()[j], chain_.upper()[j]);
      }
      Model next;
      next.evaluate(chain_, target_, std::span(tried).first(q_.size()), lever_);
      if (!(next.cost < now_.cost)) {
        damping = std::max(damping, 1e-4) * 8;
        continue;
      }
      std::copy_n(tried.begin(), q_.size(), q_.begin());
      now_ = next;
      damping = std::max(damping * 0.2, 1e-9);
    }
    return {done(options), i, now_.position_error(), now_.rotation_error};
  }

 private:
  bool done(const IkOptions& options) const {
    return now_.position_error() <= options.position_tolerance &&
           now_.rotation_error <= options.rotation_tolerance;
  }

  // Solves (J^T J + damping) step = J^T e over the joints that are free to move.
  Joints bounded_step(double damping) const {
    const auto n = Eigen::Index(q_.size());
    std::array<bool, kMaxChainJoints> held{};
    Joints step = Joints::Zero(n);
    for (Eigen::Index round = 0; round <= n; ++round) {
      Normal normal = now_.jacobian.transpose() * now_.jacobian;
      Joints right = now_.jacobian.transpose() * now_.error;
      for (Eigen::Index j = 0; j < n; ++j) {
        if (held[std::size_t(j)]) {
          normal.row(j).setZero();
          normal.col(j).setZero();
          normal(j, j) = 1;
          right[j] = 0;
        }
        normal(j, j) += damping;
      }
      step = normal.ldlt().solve(right);
      bool changed = false;
      for (Eigen::Index j = 0; j < n; ++j) {
        const auto i = std::size_t(j);
        const bool out = (q_[i] >= chain_.upper()[i] && step[j] > 0) ||
                         (q_[i] <= chain_.lower()[i] && step[j] < 0);
        if (!out || held[i]) continue;
        held[i] = changed = true;
      }
      if (!changed) break;
    }
    const double largest = step.cwiseAbs().maxCoeff();
    if (largest > kLargestStep) step *= kLargestStep / largest;
    return step;
  }

  const Chain& chain_;
  const Pose& target_;
  std::span<double> q_;
  double lever_;
  Model now_;
};

}  // namespace

IkResult solve_ik(const Chain& chain, const Pose& target, std::span<double> q,
                  const IkOptions& options) {
  PROBE_CHECK(q.size() == chain.joint_count() && !q.empty(), "one start position a joint");
  return Solver(chain, target, q, options.lever).run(options);
}

}  // namespace probe::robot
