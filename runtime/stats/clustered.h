// Rates and differences of many starts of several tasks: a start's seeds share its layout and form
// a cluster, tasks are strata. Knows nothing of runs or tables.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "runtime/stats/intervals.h"
#include "runtime/stats/paired.h"

namespace probe::stats {

// The episodes of one start in one task. Starts of several tasks that lie in the same places have
// one cluster. Ids are small numbers counted from 0.
struct StartCount {
  Count count;
  std::uint32_t task = 0;
  std::uint32_t cluster = 0;
};

// The interval of the pooled rate of starts drawn anew for the same tasks: Wilson's, with the
// episodes counted as what they are worth (Korn and Graubard 1998, Survey Methodology 24:193, give
// intervals an effective sample size in this way; Rao and Scott 1992, Biometrics 48:577).
// Episodes of one cluster that agree are worth less: by the variance by clusters over that by
// episodes, at least 1 and at most the mean cluster size, and by Student's quantile in place of the
// normal one, since that variance is estimated from few clusters. Tasks of unlike rates are worth
// more, because the tasks stay when the starts change: only the variance within tasks counts; a
// task's rate is first drawn towards the pooled one by two episodes, so that rates of 0 and 1 by
// chance do not pass for certainty. Where all episodes ended alike there is no variance to compare
// and the starts count once each. With one task and one seed it is Wilson's interval.
Interval clustered_rate(std::span<const StartCount> starts, double confidence = 0.95);

// Pairs of one start in one task; clusters as above.
struct StartPairs {
  PairTable pairs;
  std::uint32_t task = 0;
  std::uint32_t cluster = 0;
};

// rate(A) - rate(B) over all pairs: Newcombe's interval for paired proportions with the pairs
// counted as what they are worth, as in clustered_rate. Where all pairs of a task differ alike, or
// none does, there is no variance to compare and the clusters count once each, because the test of
// a difference (clustered_exact) counts them so: an interval must not exclude what the test cannot.
Difference clustered_difference(std::span<const StartPairs> pairs, double confidence = 0.95);

// rate(A) - rate(B) of starts that do not correspond: Newcombe's method 10 for independent
// proportions from both sides' clustered_rate.
Difference unpaired_difference(std::span<const StartCount> a, std::span<const StartCount> b,
                               double confidence = 0.95);

// One start of a baseline and of the variants that are measured against it: arms[0] is the
// baseline's episodes, each other arm a variant's.
using StartArms = std::vector<Count>;

// Whether the variants together differ from their baselines: the two-sided probability, over all
// choices of which arm of each start is the baseline, of a total difference at least as far from 0.
// Exact when the arms of a start are exchangeable under the hypothesis; with one variant a start it
// is clustered_exact. Pairing a baseline with each variant and flipping signs instead would count
// its episodes several times.
double shared_baseline_exact(std::span<const StartArms> starts);

// Two samples of starts that do not correspond: the two-sided probability, over all ways to deal
// the starts to the samples, of a difference of mean rates at least as large. With one episode a
// start it is Fisher's exact test (two-sided by difference).
double unpaired_exact(std::span<const Count> a, std::span<const Count> b);

}  // namespace probe::stats
