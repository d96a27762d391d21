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
};

// One start under A and B: how many of its `pairs` (seeds) each of the four outcomes had.
using Cluster = PairTable;

// McNemar's exact test: two-sided probability, at an even chance, of a split of the discordant
// pairs at least as uneven as this one. 1 without discordant pairs. (McNemar 1947, Psychometrika
// 12:153.)
double mcnemar_exact(const PairTable& table);

// The same for clusters: under the hypothesis of no difference each cluster's sum of differences is
// as likely with either sign, so the two-sided probability of a total at least as far from 0
// follows from the 2^c sign flips, counted exactly. With clusters of one pair it is McNemar's exact
// test.
double clustered_exact(std::span<const Cluster> clusters);

// rate(A) - rate(B) and Newcombe's interval for paired proportions, method 10 (Statistics in
// Medicine 1998, 17:2635): Wilson's intervals of both, squared and added with the correlation of
// the pairs.
struct Difference {
  double estimate = 0;
  Interval interval;
};
Difference newcombe_paired(const PairTable& table, double confidence = 0.95);

// Newcombe's interval with the pairs of one cluster counted as what they are worth: the table is
// divided by the design effect (variance of the difference by clusters over that by pairs; Rao and
// Scott 1992, Biometrics 48:577), which is at least 1 and at most the mean cluster size; where no
// pair differs there is no variance to compare and the clusters count once each.
Difference clustered_difference(std::span<const Cluster> clusters, double confidence = 0.95);

// rate(A) - rate(B) of two unpaired samples: Newcombe's method 10 for independent proportions
// (Statistics in Medicine 1998, 17:873).
Difference newcombe_unpaired(Count a, Count b, double confidence = 0.95);

// All clusters' pairs in one table.
PairTable pooled(std::span<const Cluster> clusters);

}  // namespace probe::stats
