// How well rates in a simulation say what rates in reality are: whether policies keep their order,
// and whether the rates lie on a line. Knows nothing of runs or tables.
#pragma once

#include <optional>
#include <span>

#include "runtime/stats/intervals.h"

namespace probe::stats {

// Mean maximum rank violation (X. Li et al. 2024, "Evaluating Real-World Robot Manipulation
// Policies in Simulation", arXiv:2405.05941, section III): of n policies with real rates R and
// simulated ones S, the mean over i of the largest |R_i - R_j| over those j that the simulation
// puts in another order, (S_i > S_j) != (R_i > R_j) for the ordered pair. 0: no order is wrong. A
// tie of one side alone is an order of the other side that is missed in one of its two directions,
// and counts. Both spans are equally long; 0 of none.
double mean_max_rank_violation(std::span<const double> real, std::span<const double> simulated);

// Pearson's correlation; nothing where either side does not vary or there are fewer than two.
std::optional<double> pearson(std::span<const double> real, std::span<const double> simulated);

// The rate of one policy on one side, in [0, 1], and of how many independent trials.
struct MeasuredRate {
  double rate = 0;
  double trials = 0;  // 0: not said
};

struct Agreement {
  double violation = 0;
  std::optional<double> correlation;
  // 95 % of what rates of these policies could be that gave these trials: both sides of each policy
  // drawn 4,000 times, independently, from Beta(k + 1/2, n - k + 1/2) (Jeffreys' prior; k = rate *
  // n need not be whole). The draws are stratified and in an order that is always the same. A
  // violation has a bound of 0 alone, and draws break ties: where policies are nearly alike its
  // interval lies above the violation of the rates as measured. Nothing where some rate has no
  // trials.
  std::optional<Interval> violation_by_trials, correlation_by_trials;
  // The least and the largest where one policy is left out: how much hangs on one. Nothing of fewer
  // than four.
  std::optional<Interval> violation_by_policies, correlation_by_policies;
};

// Rates of the same policies in the same order.
Agreement rank_agreement(std::span<const MeasuredRate> real,
                         std::span<const MeasuredRate> simulated);

}  // namespace probe::stats
