#include "runtime/stats/design.h"

#include <algorithm>
#include <boost/math/distributions/binomial.hpp>
#include <cmath>
#include <vector>

#include "runtime/base/check.h"
#include "runtime/stats/intervals.h"

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
double power_given(std::int64_t m, std::int64_t critical, double share) {
  if (critical < 0) return 0;
  const double n = static_cast<double>(m);
  const double c = static_cast<double>(critical);
  return boost::math::cdf(Binomial(n, share), c) + boost::math::cdf(Binomial(n, 1 - share), c);
}

// The numbers of discordant pairs that a design may have, with their chances and critical losses;
// those further than ten standard deviations from the mean add nothing.
struct Discordant {
  std::int64_t pairs = 0, critical = 0;
  double chance = 0;
};
std::vector<Discordant> discordant_pairs(const PairedDesign& design) {
  const double n = static_cast<double>(design.pairs);
  const Binomial discordant(n, design.discordance);
  const double mean = n * design.discordance;
  const double spread = 10 * std::sqrt(mean * (1 - design.discordance)) + 1;
  const auto first = static_cast<std::int64_t>(std::max(1.0, mean - spread));
  const auto last = static_cast<std::int64_t>(std::min(n, mean + spread));
  std::vector<Discordant> all;
  for (std::int64_t m = first; m <= last; ++m) {
    const double chance = boost::math::pdf(discordant, static_cast<double>(m));
    if (chance > 1e-12) all.push_back({m, critical_losses(m, design.alpha), chance});
  }
  return all;
}

double power_of(const std::vector<Discordant>& discordant, double share) {
  double total = 0;
  for (const Discordant& d : discordant)
    total += d.chance * power_given(d.pairs, d.critical, share);
  return std::min(1.0, total);
}

double share_won(const PairedDesign& design, double difference) {
  return (1 + difference / design.discordance) / 2;
}

}  // namespace

double power(const PairedDesign& design, double difference) {
  PROBE_CHECK(std::abs(difference) <= design.discordance && design.discordance <= 1,
              "rates cannot differ by more than the share of pairs that differ");
  if (design.pairs <= 0 || design.discordance <= 0) return 0;
  return power_of(discordant_pairs(design), share_won(design, difference));
}

std::optional<double> minimum_detectable_difference(const PairedDesign& design,
                                                    double wanted_power) {
  if (design.pairs <= 0 || design.discordance <= 0) return std::nullopt;
  const auto discordant = discordant_pairs(design);
  if (power_of(discordant, 1) < wanted_power) return std::nullopt;
  double low = 0;
  double high = design.discordance;
  while (high - low > 1e-6) {
    const double middle = (low + high) / 2;
    (power_of(discordant, share_won(design, middle)) < wanted_power ? low : high) = middle;
  }
  return high;
}

std::optional<std::int64_t> pairs_needed(double difference, double discordance, double alpha,
                                         double wanted_power) {
  constexpr double kMost = 1'000'000, kMostExact = 5'000;
  if (difference <= 0 || discordance < difference) return std::nullopt;
  // n = (z_a sqrt(q) + z_b sqrt(q - d^2))^2 / d^2, q the share that differ.
  const double root = normal_two_sided(1 - alpha) * std::sqrt(discordance) +
                      normal_two_sided(2 * wanted_power - 1) *
                          std::sqrt(std::max(0.0, discordance - difference * difference));
  double n = std::ceil(root * root / (difference * difference));
  // Fewer pairs cannot reject, whoever wins them all.
  n = std::max(n, std::ceil(1 - std::log2(alpha)));
  while (n <= kMostExact) {
    const PairedDesign design{static_cast<std::int64_t>(n), discordance, alpha};
    if (power(design, difference) >= wanted_power) break;
    n += std::max(1.0, std::floor(n / 50));
  }
  if (n > kMost) return std::nullopt;
  return static_cast<std::int64_t>(n);
}

}  // namespace probe::stats
