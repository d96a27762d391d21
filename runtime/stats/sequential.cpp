#include "runtime/stats/sequential.h"

#include <algorithm>
#include <boost/math/special_functions/gamma.hpp>
#include <cmath>
#include <numbers>

namespace probe::stats {

void SequentialComparison::add(std::int64_t a_minus_b) {
  if (a_minus_b == 0) return;
  ++(a_minus_b > 0 ? a_wins_ : b_wins_);
  largest_log_evidence_ = std::max(largest_log_evidence_, log_evidence());
}

double SequentialComparison::log_evidence() const {
  const double w = static_cast<double>(a_wins_);
  const double l = static_cast<double>(b_wins_);
  // B(1/2, 1/2) is pi.
  return (w + l) * std::numbers::ln2 + boost::math::lgamma(w + 0.5) + boost::math::lgamma(l + 0.5) -
         boost::math::lgamma(w + l + 1) - std::log(std::numbers::pi);
}

double SequentialComparison::p_value() const { return std::exp(-largest_log_evidence_); }

}  // namespace probe::stats
