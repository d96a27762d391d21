// The two questions that the difference of two policies, or of a variant and its baseline, is
// asked. The same counts may answer one and not the other.
//
// *On these starts*: does it matter, on the very starts that were run, which of the two acted? The
// sharp hypothesis says that on each of them the two could have been exchanged. Every start is a
// finding of its own, wherever it lies: 144 starts won of 144 are 2^-143, in however few places.
//
// *For starts never tried*: would it matter in places drawn anew? The hypothesis says that a place
// favours either side as likely. The starts of several tasks in one place are one finding, since
// what is odd about the place is odd for all of them: 6 places won of 6 are 2^-5, for however many
// tasks. Tasks are strata: they stay, and what they have in common is not learnt from their places.
//
// Where every start lies in a place of its own, as those of a single task do, both have one
// finding.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "runtime/stats/paired.h"

namespace probe::stats {

// Pairs of one start of one task. Ids are small numbers counted from 0. `start` is what is
// exchanged as a whole on these starts: rows that share a baseline's episodes share it.
struct PlacedPairs {
  PairTable pairs;
  std::uint32_t task = 0, start = 0, place = 0;
};

struct Finding {
  Interval interval;               // of the difference
  double p = 1;                    // two-sided and exact: sign flips of the units' nets
  std::vector<std::int64_t> nets;  // by unit, a start or a place: successes of A less those of B
};

struct HereAndAnew {
  double difference = 0;  // rate(A) - rate(B) over all pairs
  Finding here;           // on these starts
  Finding anew;           // for starts never tried
};

// Intervals are clustered_difference's, by start and by place: an interval of these starts takes
// what differs from start to start for chance, since one episode a start cannot tell the two apart,
// and so covers no less than it says.
HereAndAnew compare_here_and_anew(std::span<const PlacedPairs> pairs, double confidence = 0.95);

}  // namespace probe::stats
