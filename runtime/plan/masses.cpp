#include "runtime/plan/masses.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>

#include "runtime/base/geometry.h"

namespace probe::plan {

std::optional<std::string> inertia_fault(const std::array<double, 6>& inertia) {
  constexpr double kRounding = 1e-3;
  const auto [xx, yy, zz, xy, xz, yz] = inertia;
  Mat3 tensor;
  tensor << xx, xy, xz, xy, yy, yz, xz, yz, zz;
  const Vec3 e = Eigen::SelfAdjointEigenSolver<Mat3>(tensor, Eigen::EigenvaluesOnly).eigenvalues();
  if (!(e[0] > 0))
    return fmt::format("its least principal moment is {:.4g} kgm2, which must be above 0", e[0]);
  if (e[0] + e[1] < e[2] * (1 - kRounding))
    return fmt::format(
        "no body has the principal moments {:.4g}, {:.4g} and {:.4g} kgm2: the last exceeds the "
        "sum of the others",
        e[0], e[1], e[2]);
  return std::nullopt;
}

}  // namespace probe::plan
