#include "runtime/stats/betting.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace probe::stats {
namespace {

// Below 1/2, so that no factor is 0 whatever `least` is; each the root of 1/2 of the one before.
constexpr std::size_t kBets = 16;
constexpr double kLargestBet = 0.495;

// In an order of its own, so that sums do not depend on that of the starts.
std::vector<BoundedOutcome> in_order(std::span<const BoundedOutcome> outcomes) {
  std::vector<BoundedOutcome> sorted(outcomes.begin(), outcomes.end());
  std::sort(sorted.begin(), sorted.end(), [](const BoundedOutcome& a, const BoundedOutcome& b) {
    return a.value != b.value ? a.value < b.value : a.weight < b.weight;
  });
  return sorted;
}

double log_evidence(const std::vector<BoundedOutcome>& sorted, double least) {
  std::array<double, kBets> logs{};
  double bet = kLargestBet;
  for (double& log : logs) {
    // Many starts have one outcome: a logarithm for each run of equal ones.
    for (std::size_t i = 0; i < sorted.size();) {
      std::size_t end = i + 1;
      while (end < sorted.size() && sorted[end].value == sorted[i].value &&
             sorted[end].weight == sorted[i].weight)
        ++end;
      log += static_cast<double>(end - i) *
             std::log1p(bet * sorted[i].weight * (least - sorted[i].value));
      i = end;
    }
    bet *= std::sqrt(0.5);
  }
  const double largest = *std::max_element(logs.begin(), logs.end());
  double sum = 0;
  for (const double log : logs) sum += std::exp(log - largest);
  return largest + std::log(sum / static_cast<double>(kBets));
}

// The largest mean that is not refused: the evidence against a mean grows with it.
double upper_bound(const std::vector<BoundedOutcome>& sorted, double log_limit) {
  if (log_evidence(sorted, 1) < log_limit) return 1;
  double low = -1, high = 1;
  for (int i = 0; i < 60; ++i) {
    const double middle = low + (high - low) / 2;
    (log_evidence(sorted, middle) < log_limit ? low : high) = middle;
  }
  return high;
}

}  // namespace

double log_evidence_below(std::span<const BoundedOutcome> outcomes, double least) {
  return log_evidence(in_order(outcomes), least);
}

Interval bounds_by_betting(std::span<const BoundedOutcome> outcomes, double confidence) {
  const double log_limit = std::log(2 / (1 - confidence));
  std::vector<BoundedOutcome> mirrored(outcomes.begin(), outcomes.end());
  for (BoundedOutcome& outcome : mirrored) outcome.value = -outcome.value;
  return {-upper_bound(in_order(mirrored), log_limit), upper_bound(in_order(outcomes), log_limit)};
}

}  // namespace probe::stats
