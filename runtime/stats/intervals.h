// Confidence intervals of one proportion: k successes of n episodes. Knows nothing of runs or
// tables.
#pragma once

#include <cstdint>

namespace probe::stats {

// Both ends in [0, 1] for a proportion, in [-1, 1] for a difference of two.
struct Interval {
  double low = 0;
  double high = 0;
};

// k successes of n independent episodes; 0 <= k <= n.
struct Count {
  std::int64_t k = 0;
  std::int64_t n = 0;

  // k / n; not a number when n is 0.
  double rate() const;
};

// The upper quantile of the standard normal distribution that a two-sided interval of `confidence`
// (0.95 gives 1.959964) is made with. `confidence` lies strictly between 0 and 1 everywhere here.
double normal_two_sided(double confidence);
// The same of Student's distribution with `freedom` degrees of freedom, > 0.
double student_two_sided(double confidence, double freedom);

// Wilson's score interval (Wilson 1927, JASA 22:209): the roots of the score test. Near its nominal
// coverage for every n. With n = 0 it is [0, 1]: nothing is known.
Interval wilson(Count count, double confidence = 0.95);

// Wilson's interval of a rate that is worth `n` independent episodes, n > 0 and not always whole:
// what a survey's design effect leaves of them.
Interval wilson_effective(double rate, double n, double confidence = 0.95);

}  // namespace probe::stats
