#include "runtime/stats/paired.h"

#include <algorithm>
#include <boost/math/distributions/binomial.hpp>
#include <cmath>
#include <vector>

namespace probe::stats {
namespace {

// Newcombe's method 10 takes its counts as real numbers, so that a design effect can scale them.
struct RealTable {
  double both = 0, only_a = 0, only_b = 0, neither = 0;
};

Interval wilson_real(double k, double n, double z) {
  const double p = k / n;
  const double scale = 1 / (1 + z * z / n);
  const double centre = scale * (p + z * z / (2 * n));
  const double half = scale * z * std::sqrt(std::max(0.0, p * (1 - p)) / n + z * z / (4 * n * n));
  return {std::max(0.0, centre - half), std::min(1.0, centre + half)};
}

// The correlation of the pairs, with the continuity correction that Newcombe gives for a positive
// one.
double pair_correlation(const RealTable& t, double n) {
  const double margins =
      (t.both + t.only_a) * (t.only_b + t.neither) * (t.both + t.only_b) * (t.only_a + t.neither);
  if (margins <= 0) return 0;
  const double product = t.both * t.neither - t.only_a * t.only_b;
  const double corrected = product > 0 ? std::max(product - n / 2, 0.0) : product;
  return corrected / std::sqrt(margins);
}

// Squares of the two limits' distances, added with their correlation.
double joined(double a, double b, double correlation) {
  return std::sqrt(std::max(0.0, a * a - 2 * correlation * a * b + b * b));
}

Difference newcombe(const RealTable& t, double confidence) {
  const double n = t.both + t.only_a + t.only_b + t.neither;
  if (n <= 0) return {0, {-1, 1}};
  const double z = normal_two_sided(confidence);
  const double a = (t.both + t.only_a) / n;
  const double b = (t.both + t.only_b) / n;
  const Interval wa = wilson_real(t.both + t.only_a, n, z);
  const Interval wb = wilson_real(t.both + t.only_b, n, z);
  const double phi = pair_correlation(t, n);
  const double estimate = a - b;
  return {estimate,
          {std::max(-1.0, estimate - joined(a - wa.low, wb.high - b, phi)),
           std::min(1.0, estimate + joined(wa.high - a, b - wb.low, phi))}};
}

RealTable scaled(const PairTable& t, double factor) {
  return {static_cast<double>(t.both) * factor, static_cast<double>(t.only_a) * factor,
          static_cast<double>(t.only_b) * factor, static_cast<double>(t.neither) * factor};
}

std::int64_t net(const Cluster& c) { return c.only_a - c.only_b; }

}  // namespace

double mcnemar_exact(const PairTable& table) {
  const std::int64_t discordant = table.only_a + table.only_b;
  if (discordant == 0) return 1;
  const boost::math::binomial_distribution<> even(static_cast<double>(discordant), 0.5);
  const double fewer = static_cast<double>(std::min(table.only_a, table.only_b));
  return std::min(1.0, 2 * boost::math::cdf(even, fewer));
}

double clustered_exact(std::span<const Cluster> clusters) {
  std::int64_t observed = 0;
  std::int64_t reach = 0;
  for (const Cluster& c : clusters) {
    observed += net(c);
    reach += std::abs(net(c));
  }
  if (reach == 0) return 1;
  // chance[s + reach] of the flipped total s, a cluster at a time.
  std::vector<double> chance(static_cast<std::size_t>(2 * reach + 1), 0.0);
  std::vector<double> next(chance.size(), 0.0);
  chance[static_cast<std::size_t>(reach)] = 1;
  std::int64_t so_far = 0;
  for (const Cluster& c : clusters) {
    const std::int64_t d = std::abs(net(c));
    if (d == 0) continue;
    std::fill(next.begin(), next.end(), 0.0);
    for (std::int64_t s = -so_far; s <= so_far; ++s) {
      const double half = chance[static_cast<std::size_t>(s + reach)] / 2;
      next[static_cast<std::size_t>(s + d + reach)] += half;
      next[static_cast<std::size_t>(s - d + reach)] += half;
    }
    so_far += d;
    chance.swap(next);
  }
  double tail = 0;
  for (std::int64_t s = -reach; s <= reach; ++s) {
    if (std::abs(s) >= std::abs(observed)) tail += chance[static_cast<std::size_t>(s + reach)];
  }
  return std::min(1.0, tail);
}

Difference newcombe_paired(const PairTable& table, double confidence) {
  return newcombe(scaled(table, 1), confidence);
}

Difference clustered_difference(std::span<const Cluster> clusters, double confidence) {
  const PairTable all = pooled(clusters);
  const double n = static_cast<double>(all.pairs());
  std::int64_t used = 0;
  for (const Cluster& c : clusters) used += c.pairs() > 0 ? 1 : 0;
  if (used == 0) return newcombe(scaled(all, 1), confidence);
  const double clusters_used = static_cast<double>(used);
  const double mean_size = n / clusters_used;
  const double d = static_cast<double>(net(all)) / n;
  const double by_pairs = static_cast<double>(all.only_a + all.only_b) - n * d * d;
  double by_clusters = 0;
  for (const Cluster& c : clusters) {
    const double residual = static_cast<double>(net(c)) - static_cast<double>(c.pairs()) * d;
    by_clusters += residual * residual;
  }
  if (used > 1) by_clusters *= clusters_used / (clusters_used - 1);
  double effect = mean_size;
  if (by_pairs > 0) effect = std::clamp(by_clusters / by_pairs, 1.0, mean_size);
  return newcombe(scaled(all, 1 / effect), confidence);
}

Difference newcombe_unpaired(Count a, Count b, double confidence) {
  if (a.n == 0 || b.n == 0) return {0, {-1, 1}};
  const Interval wa = wilson(a, confidence);
  const Interval wb = wilson(b, confidence);
  const double estimate = a.rate() - b.rate();
  return {estimate,
          {estimate - joined(a.rate() - wa.low, wb.high - b.rate(), 0),
           estimate + joined(wa.high - a.rate(), b.rate() - wb.low, 0)}};
}

PairTable pooled(std::span<const Cluster> clusters) {
  PairTable all;
  for (const Cluster& c : clusters) {
    all.both += c.both;
    all.only_a += c.only_a;
    all.only_b += c.only_b;
    all.neither += c.neither;
  }
  return all;
}

}  // namespace probe::stats
