// Least squares of one factor a joint, with a prior.
#include "runtime/expert/drive_response.h"

#include <algorithm>

namespace probe::expert {
namespace {

// Before anything is seen: drives of about a quarter second. It weighs as much as one move of 0.02
// rad.
constexpr double kUsualLeft = 0.4;
constexpr double kPriorSquare = 0.02 * 0.02;

}  // namespace

void DriveResponse::reset() { sums_.fill({kUsualLeft * kPriorSquare, kPriorSquare}); }

void DriveResponse::learn(std::span<const double> before, std::span<const double> target,
                          std::span<const double> after) {
  for (std::size_t j = 0; j < target.size(); ++j) {
    const double ahead = target[j] - before[j], left = target[j] - after[j];
    sums_[j].product += ahead * left;
    sums_[j].square += ahead * ahead;
  }
}

double DriveResponse::lead(std::size_t j) const {
  const double left = std::clamp(sums_[j].product / sums_[j].square, 0.0, 0.6);
  return 1 / (1 - left);
}

}  // namespace probe::expert
