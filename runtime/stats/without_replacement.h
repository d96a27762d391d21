// How sure is the rate of a finite list of episodes, of which those at its beginning have been run,
// when one may look after every episode and stop whenever one likes.
#pragma once

#include <cstdint>
#include <span>

#include "runtime/stats/intervals.h"

namespace probe::stats {

// A list in an order that was drawn beforehand, run from its beginning: what became of `drawn()` of
// its `total` outcomes. Those that are unknown have been run, but nobody can say how they ended.
struct Drawn {
  std::int64_t total = 0;
  std::int64_t successes = 0, failures = 0, unknown = 0;

  std::int64_t drawn() const { return successes + failures + unknown; }
};

// The natural logarithm of the evidence against "the whole list has `all` successes" when
// `successes` and `failures` have been drawn: the capital of one who began with 1 and betted on each
// outcome as the list of such a number has it, with the shares of Krichevsky and Trofimov (1981,
// IEEE Transactions on Information Theory 27:199; a Beta(1/2, 1/2) mixture). It is the ratio of
// prior to posterior of Waudby-Smith and Ramdas ("Confidence sequences for sampling without
// replacement", NeurIPS 2020, section 2, beta-binomial), hence a martingale with mean 1 under the
// hypothesis and by Ville's inequality ever above 1 / e with chance at most e. Infinite where the
// hypothesis cannot be. Convex in `all`.
double log_evidence_against(std::int64_t total, std::int64_t all, std::int64_t successes,
                            std::int64_t failures);

// The rate of the whole list with all that is not refused: with that confidence at all times
// together, so also at the time somebody chose to stop at. When all has been drawn it is the rate
// itself. What is unknown may have been either: the interval is the widest of all ways to fill it
// in. [0, 1] while nothing is drawn.
Interval rate_of_drawn(const Drawn& list, double confidence = 0.95);

// How several lists were drawn, each in an order of its own.
enum class Drawing : std::uint8_t {
  // The next list to draw from was chosen by what was drawn before, and by nothing else.
  kInTurn,
  // Nobody can say.
  kAnyhow,
};

// The rate of all lists together, as if they were one, with a confidence at all times. In turn, the
// product of the evidence against each list is a martingale again, and the mean over all numbers of
// successes that it does not refuse is the interval (union-intersection: Spertus, Sridhar and Stark
// 2024, "Sequential stratified inference for the mean"; found exactly, since the logarithms are
// convex, by taking the cheapest success next). Else each list has its part of the error, and their
// intervals are added (Bonferroni).
Interval rate_of_lists(std::span<const Drawn> lists, Drawing drawing, double confidence = 0.95);

}  // namespace probe::stats
