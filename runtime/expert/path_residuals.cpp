// Values and derivatives of each.
#include "runtime/expert/path_residuals.h"

#include <algorithm>
#include <cmath>

#include "runtime/base/trig.h"
#include "runtime/robot/rotation.h"

namespace probe::expert {
namespace {

using robot::Jacobian;

Mat3 skew(const Vec3& v) {
  Mat3 m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

// d v = inverse_left(v) omega dt if a rotation exp(v) turns by omega in the fixed frame: the
// inverse left Jacobian of SO(3) (Chirikjian, Stochastic Models 2, 10.86).
Mat3 inverse_left(const Vec3& v) {
  const Mat3 s = skew(v);
  const double angle = v.norm();
  double factor = 1.0 / 12;
  if (angle > 1e-4) {
    const SinCos t = portable_sincos(angle);
    factor = 1 / (angle * angle) - (1 + t.cos) / (2 * angle * t.sin);
  }
  return Mat3::Identity() - 0.5 * s + factor * s * s;
}

class Difference final : public Residual {
 public:
  Difference(std::vector<StepShare> shares, double weight)
      : Residual(std::move(shares)), weight_(weight) {}

  void evaluate(const JointVector& x, Eigen::VectorXd& r,
                Eigen::MatrixXd* jacobian) const override {
    r = weight_ * x;
    if (jacobian) *jacobian = weight_ * Eigen::MatrixXd::Identity(x.size(), x.size());
  }

 private:
  double weight_;
};

class ViaResidual final : public Residual {
 public:
  ViaResidual(const robot::Chain& chain, const Via& wanted)
      : Residual({{wanted.step, 1}}), chain_(chain), wanted_(wanted) {}

  void evaluate(const JointVector& x, Eigen::VectorXd& r,
                Eigen::MatrixXd* jacobian) const override {
    Jacobian j;
    const Pose pose = chain_.pose(span_of(x), j);
    const Vec3 turn = robot::to_rotation_vector(pose.rotation * wanted_.pose.rotation.conjugate());
    r.resize(6);
    r.head<3>() = wanted_.position_weight.cwiseProduct(pose.position - wanted_.pose.position);
    r.tail<3>() = wanted_.rotation_weight * turn;
    if (!jacobian) return;
    jacobian->resize(6, x.size());
    jacobian->topRows<3>() = wanted_.position_weight.asDiagonal() * j.topRows<3>();
    jacobian->bottomRows<3>() = wanted_.rotation_weight * inverse_left(turn) * j.bottomRows<3>();
  }

 private:
  const robot::Chain& chain_;
  Via wanted_;
};

class Upright final : public Residual {
 public:
  Upright(const robot::Chain& chain, int step, double weight)
      : Residual({{step, 1}}), chain_(chain), weight_(weight) {}

  void evaluate(const JointVector& x, Eigen::VectorXd& r,
                Eigen::MatrixXd* jacobian) const override {
    Jacobian j;
    const Pose pose = chain_.pose(span_of(x), j);
    const Vec3 axis = pose.rotation * Vec3::UnitX();
    r = weight_ * axis.head<2>();
    if (jacobian) *jacobian = weight_ * (-skew(axis) * j.bottomRows<3>()).topRows<2>();
  }

 private:
  const robot::Chain& chain_;
  double weight_;
};

class ClearanceResidual final : public Residual {
 public:
  ClearanceResidual(const robot::Chain& chain, std::span<const Ball> balls,
                    const Obstacles& obstacles, const Clearance& wanted)
      : Residual(wanted.at),
        chain_(chain),
        balls_(balls),
        obstacles_(obstacles),
        margin_(wanted.margin),
        weight_(wanted.weight) {}

  void evaluate(const JointVector& x, Eigen::VectorXd& r,
                Eigen::MatrixXd* jacobian) const override {
    Jacobian j;
    const Pose pose = chain_.pose(span_of(x), j);
    const auto count = static_cast<Eigen::Index>(balls_.size());
    r.setZero(count);
    if (jacobian) jacobian->setZero(count, x.size());
    for (Eigen::Index i = 0; i < count; ++i) {
      const Ball& ball = balls_[static_cast<std::size_t>(i)];
      const double wanted = margin_ + ball.radius;
      const Vec3 arm = pose.rotation * ball.center;
      const Distance d = obstacles_.nearest(pose.position + arm, wanted);
      if (d.value >= wanted) continue;
      r[i] = weight_ * (wanted - d.value);
      if (!jacobian) continue;
      jacobian->row(i) = -weight_ * (d.gradient.transpose() * j.topRows<3>() +
                                     arm.cross(d.gradient).transpose() * j.bottomRows<3>());
    }
  }

 private:
  const robot::Chain& chain_;
  std::span<const Ball> balls_;
  const Obstacles& obstacles_;
  double margin_, weight_;
};

// Rows that are zero where lower <= x <= upper.
class Bounds final : public Residual {
 public:
  Bounds(std::vector<StepShare> shares, JointVector lower, JointVector upper, double weight)
      : Residual(std::move(shares)),
        lower_(std::move(lower)),
        upper_(std::move(upper)),
        weight_(weight) {}

  void evaluate(const JointVector& x, Eigen::VectorXd& r,
                Eigen::MatrixXd* jacobian) const override {
    r.setZero(x.size());
    if (jacobian) jacobian->setZero(x.size(), x.size());
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      if (x[i] >= lower_[i] && x[i] <= upper_[i]) continue;
      r[i] = weight_ * (x[i] - (x[i] < lower_[i] ? lower_[i] : upper_[i]));
      if (jacobian) (*jacobian)(i, i) = weight_;
    }
  }

 private:
  JointVector lower_, upper_;
  double weight_;
};

}  // namespace

std::unique_ptr<Residual> difference(int step, int order, double weight) {
  std::vector<StepShare> shares{{step, 1}};
  double factor = 1;
  for (int i = 1; i <= order; ++i) {
    factor *= -static_cast<double>(order - i + 1) / i;
    shares.push_back({step - i, factor});
  }
  return std::make_unique<Difference>(std::move(shares), weight);
}

std::unique_ptr<Residual> via(const robot::Chain& chain, const Via& wanted) {
  return std::make_unique<ViaResidual>(chain, wanted);
}

std::unique_ptr<Residual> upright(const robot::Chain& chain, int step, double weight) {
  return std::make_unique<Upright>(chain, step, weight);
}

std::unique_ptr<Residual> clearance(const robot::Chain& chain, std::span<const Ball> balls,
                                    const Obstacles& obstacles, const Clearance& wanted) {
  return std::make_unique<ClearanceResidual>(chain, balls, obstacles, wanted);
}

std::unique_ptr<Residual> joint_limits(const robot::Chain& chain, int step, double margin,
                                       double weight) {
  const auto n = static_cast<Eigen::Index>(chain.joint_count());
  JointVector lower(n), upper(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    lower[i] = chain.lower()[static_cast<std::size_t>(i)] + margin;
    upper[i] = chain.upper()[static_cast<std::size_t>(i)] - margin;
  }
  return std::make_unique<Bounds>(std::vector<StepShare>{{step, 1}}, std::move(lower),
                                  std::move(upper), weight);
}

std::unique_ptr<Residual> move_limit(int step, double most, double weight) {
  // For as many joints as any chain has; the argument uses the first.
  const JointVector bound = JointVector::Constant(robot::kMaxChainJoints, most);
  return std::make_unique<Bounds>(std::vector<StepShare>{{step, 1}, {step - 1, -1}}, -bound, bound,
                                  weight);
}

double least_clearance(const Pose& tool, std::span<const Ball> balls, const Obstacles& obstacles,
                       double beyond) {
  double least = beyond;
  for (const Ball& ball : balls) {
    const Distance d = obstacles.nearest(tool.apply(ball.center), least + ball.radius);
    least = std::min(least, d.value - ball.radius);
  }
  return least;
}

}  // namespace probe::expert
