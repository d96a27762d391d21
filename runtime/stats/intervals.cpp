#include "runtime/stats/intervals.h"

#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <limits>

#include "runtime/base/check.h"

namespace probe::stats {
namespace {

constexpr Interval kUnknown{0, 1};

void check(Count count, double confidence) {
  PROBE_CHECK(count.k >= 0 && count.k <= count.n, "a count of successes lies in 0..n");
  PROBE_CHECK(confidence > 0 && confidence < 1, "a confidence lies between 0 and 1");
}

}  // namespace

double Count::rate() const {
  if (n == 0) return std::numeric_limits<double>::quiet_NaN();
  return static_cast<double>(k) / static_cast<double>(n);
}

double normal_two_sided(double confidence) {
  return boost::math::quantile(boost::math::normal_distribution<>(), 0.5 + confidence / 2);
}

double student_two_sided(double confidence, double freedom) {
  return boost::math::quantile(boost::math::students_t_distribution<>(freedom),
                               0.5 + confidence / 2);
}

Interval wilson(Count count, double confidence) {
  check(count, confidence);
  if (count.n == 0) return kUnknown;
  return wilson_effective(count.rate(), static_cast<double>(count.n), confidence);
}

Interval wilson_effective(double p, double n, double confidence) {
  PROBE_CHECK(p >= 0 && p <= 1 && n > 0, "a rate lies in 0..1 and some episode was seen");
  const double z = normal_two_sided(confidence);
  const double scale = 1 / (1 + z * z / n);
  const double centre = scale * (p + z * z / (2 * n));
  const double half = scale * z * std::sqrt(p * (1 - p) / n + z * z / (4 * n * n));
  // At 0 and 1 one end is exactly the rate; rounding must not say otherwise.
  return {p == 0 ? 0 : centre - half, p == 1 ? 1 : centre + half};
}

}  // namespace probe::stats
