#include "runtime/stats/design.h"

#include <algorithm>
#include <boost/math/distributions/binomial.hpp>
#include <cmath>

#include "runtime/base/check.h"

namespace probe::stats {
namespace {

using Binomial = boost::math::binomial_distribution<>;

// The most losses of m even discordant pairs that still reject, or -1: the largest c with
// 2 P(X <= c) <= alpha.
std::int64_t critical_losses(std::int64_t m, double alpha) {
  const Binomial even(static_cast<double>(m), 0.5);
  std::int64_t low = -1;
  std::int64_t high = m / 2;
  while (low < high) {
    const std::int64_t middle = low + (high - low + 1) / 2;
    if (2 * boost::math::cdf(even, static_cast<double>(middle)) <= alpha) {
      low = middle;
    } else {
      high = middle - 1;
    }
  }
  return low;
}

// P(rejected | m discordant pairs, each won by A with chance `share`).
double power_given(std::int64_t m, double share, double alpha) {
  const std::int64_t critical = critical_losses(m, alpha);
  if (critical < 0) return 0;
  const double n = static_cast<double>(m);
  const double c = static_cast<double>(critical);
  return boost::math::cdf(Binomial(n, share), c) + boost::math::cdf(Binomial(n, 1 - share), c);
}

}  // namespace

double power(const PairedDesign& design, double difference) {
  PROBE_CHECK(std::abs(difference) <= design.discordance && design.discordance <= 1,
              "rates cannot differ by more than the share of pairs that differ");
  if (design.pairs <= 0 || design.discordance <= 0) return 0;
  const double share = (1 + difference / design.discordance) / 2;
  const double n = static_cast<double>(design.pairs);
  const Binomial discordant(n, design.discordance);
  // Numbers of discordant pairs further than ten standard deviations from the mean add nothing.
  const double mean = n * design.discordance;
  const double spread = 10 * std::sqrt(mean * (1 - design.discordance)) + 1;
  const auto first = static_cast<std::int64_t>(std::max(1.0, mean - spread));
  const auto last = static_cast<std::int64_t>(std::min(n, mean + spread));
  double total = 0;
  for (std::int64_t m = first; m <= last; ++m) {
    total +=
        boost::math::pdf(discordant, static_cast<double>(m)) * power_given(m, share, design.alpha);
  }
  return std::min(1.0, total);
}

std::optional<double> minimum_detectable_difference(const PairedDesign& design,
                                                    double wanted_power) {
  if (power(design, design.discordance) < wanted_power) return std::nullopt;
  double low = 0;
  double high = design.discordance;
  while (high - low > 1e-6) {
    const double middle = (low + high) / 2;
    (power(design, middle) < wanted_power ? low : high) = middle;
  }
  return high;
}

}  // namespace probe::stats
