// The band is stored as the lower triangle of a sparse matrix whose columns are full down to the
// last coupled block, so that an entry's place follows from its row and column.
#include "runtime/expert/normal_equations.h"

#include <algorithm>

#include <Eigen/CholmodSupport>

#include "runtime/base/check.h"

namespace probe::expert {

struct NormalEquations::State {
  int size = 0, band = 0, unknowns = 0;
  Eigen::SparseMatrix<double> lower, damped;
  Eigen::VectorXd gradient;
  Eigen::CholmodSimplicialLLT<Eigen::SparseMatrix<double>, Eigen::Lower> cholmod;
  bool analysed = false;

  double& at(int row, int column) {
    return lower.valuePtr()[lower.outerIndexPtr()[column] + row - column];
  }
};

NormalEquations::NormalEquations(int blocks, int size, int band)
    : state_(std::make_unique<State>()) {
  PROBE_CHECK(blocks > 0 && size > 0 && band >= 0, "normal equations have unknowns");
  State& s = *state_;
  s.size = size;
  s.band = band;
  s.unknowns = blocks * size;
  const auto below = [&](int column) {
    return std::min(s.unknowns, (column / size + band + 1) * size) - column;
  };
  s.lower.resize(s.unknowns, s.unknowns);
  Eigen::VectorXi heights(s.unknowns);
  for (int c = 0; c < s.unknowns; ++c) heights[c] = below(c);
  s.lower.reserve(heights);
  for (int c = 0; c < s.unknowns; ++c) {
    for (int i = 0; i < heights[c]; ++i) s.lower.insert(c + i, c) = 0;
  }
  s.lower.makeCompressed();
  s.gradient = Eigen::VectorXd::Zero(s.unknowns);
  // A band is already in the order that fills least.
  s.cholmod.cholmod().nmethods = 1;
  s.cholmod.cholmod().method[0].ordering = CHOLMOD_NATURAL;
  s.cholmod.cholmod().postorder = 0;
  s.cholmod.cholmod().print = 0;  // what fails is told by solve()
}

NormalEquations::~NormalEquations() = default;
NormalEquations::NormalEquations(NormalEquations&&) noexcept = default;
NormalEquations& NormalEquations::operator=(NormalEquations&&) noexcept = default;

void NormalEquations::clear() {
  State& s = *state_;
  std::fill_n(s.lower.valuePtr(), s.lower.nonZeros(), 0.0);
  s.gradient.setZero();
}

void NormalEquations::add(std::span<const Share> shares, const Eigen::MatrixXd& jacobian,
                          const Eigen::VectorXd& residual) {
  State& s = *state_;
  const Eigen::MatrixXd square = jacobian.transpose() * jacobian;
  const Eigen::VectorXd slope = jacobian.transpose() * residual;
  for (const Share& a : shares) {
    s.gradient.segment(a.block * s.size, s.size) += a.factor * slope;
    for (const Share& b : shares) {
      if (b.block > a.block) continue;
      PROBE_CHECK(a.block - b.block <= s.band, "a residual stays within the band");
      const double factor = a.factor * b.factor;
      for (int j = 0; j < s.size; ++j) {
        const int column = b.block * s.size + j;
        for (int i = a.block == b.block ? j : 0; i < s.size; ++i) {
          s.at(a.block * s.size + i, column) += factor * square(i, j);
        }
      }
    }
  }
}

bool NormalEquations::solve(double damping, Eigen::VectorXd& step) {
  State& s = *state_;
  s.damped = s.lower;
  for (int c = 0; c < s.unknowns; ++c) {
    s.damped.valuePtr()[s.damped.outerIndexPtr()[c]] *= 1 + damping;
  }
  if (!s.analysed) {
    s.cholmod.analyzePattern(s.damped);
    s.analysed = true;
  }
  s.cholmod.factorize(s.damped);
  if (s.cholmod.info() != Eigen::Success) return false;
  step = s.cholmod.solve(-s.gradient);
  return s.cholmod.info() == Eigen::Success && step.allFinite();
}

const Eigen::VectorXd& NormalEquations::gradient() const { return state_->gradient; }

Eigen::MatrixXd NormalEquations::dense() const {
  const Eigen::MatrixXd lower = state_->lower;
  return lower.selfadjointView<Eigen::Lower>();
}

}  // namespace probe::expert
