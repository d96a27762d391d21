// Two policies, or a variant and its baseline, on the same starts: exact tests and intervals of the
// difference. A pair is one start; where seeds repeat a start, their episodes form one cluster,
// because they share its layout.
#pragma once

#include <cstdint>
#include <span>

#include "runtime/stats/intervals.h"

namespace probe::stats {

// The 2 x 2 table of pairs: what A did, then what B did.
struct PairTable {
  std::int64_t both = 0;
  std::int64_t only_a = 0;
  std::int64_t only_b = 0;
  std::int64_t neither = 0;

  std::int64_t pairs() const { return both + only_a + only_b + neither; }
  std::int64_t net() const { return only_a - only_b; }  // successes of A less those of B
  PairTable operator+(const PairTable& other) const {
    return {both + other.both, only_a + other.only_a, only_b + other.only_b,
            neither + other.neither};
  }
};

// One start under A and B: how many of its `pairs` (seeds) each of the four outcomes had.
using Cluster = PairTable;

// Whether A and B differ, by sign flips: under the hypothesis of no difference each cluster's sum
// of differences is as likely with either sign, so the two-sided probability of a total at least as
// far from 0 follows from the 2^c choices of signs, exactly. With clusters of one pair it is
// McNemar's exact test (1947, Psychometrika 12:153), the binomial test of the pairs that differ.
double clustered_exact(std::span<const Cluster> clusters);

// rate(A) - rate(B) and Newcombe's interval for paired proportions, method 10 (Statistics in
// Medicine 1998, 17:2635): Wilson's intervals of both, squared and added with the correlation of
// the pairs.
struct Difference {
  double estimate = 0;
  Interval interval;
};
// The pairs are counted as `n` independent ones, n > 0 and not always whole: as many as there are,
// or what a design effect leaves of them. Without a pair nothing is known: 0, from -1 to 1.
Difference newcombe_paired(const PairTable& table, double n, double confidence = 0.95);

// rate(A) - rate(B) of two samples that are not paired, from their rates and intervals: Newcombe's
// method 10 for independent proportions (Statistics in Medicine 1998, 17:873), where the intervals
// are Wilson's.
Difference unpaired_from(double a, const Interval& of_a, double b, const Interval& of_b);

}  // namespace probe::stats
