#include "runtime/stats/paired.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "runtime/stats/exact_sum.h"

namespace probe::stats {
namespace {

// Newcombe's method 10 takes its counts as real numbers, so that a design effect can scale them.
struct RealTable {
  double both = 0, only_a = 0, only_b = 0, neither = 0;
};

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
  const double a = std::min(1.0, (t.both + t.only_a) / n);  // scaled counts round
  const double b = std::min(1.0, (t.both + t.only_b) / n);
  const Interval wa = wilson_effective(a, n, confidence);
  const Interval wb = wilson_effective(b, n, confidence);
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

}  // namespace

double clustered_exact(std::span<const Cluster> clusters) {
  ExactSum sum;
  std::int64_t observed = 0;
  for (const Cluster& c : clusters) {
    observed += c.net();
    if (c.net() != 0) sum.add(std::array{c.net(), -c.net()});
  }
  return sum.tail(observed);
}

Difference newcombe_paired(const PairTable& table, double n, double confidence) {
  if (table.pairs() == 0) return {0, {-1, 1}};
  return newcombe(scaled(table, n / static_cast<double>(table.pairs())), confidence);
}

Difference unpaired_from(double a, const Interval& of_a, double b, const Interval& of_b) {
  return {a - b,
          {a - b - joined(a - of_a.low, of_b.high - b, 0),
           a - b + joined(of_a.high - a, b - of_b.low, 0)}};
}

}  // namespace probe::stats
