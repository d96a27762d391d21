// Whether a mean lies below a bound, from bounded outcomes that need not have one distribution, at
// any time: evidence by betting.
#pragma once

#include <span>

#include "runtime/stats/intervals.h"

namespace probe::stats {

// One start: the mean of its outcomes, from -1 to 1, and what share of the largest start's outcomes
// it has, above 0 and at most 1.
struct BoundedOutcome {
  double value = 0;
  double weight = 1;
};

// The natural logarithm of the evidence against "the weighted mean that these outcomes are expected
// to have is at least `least`" (-1 to 1): the capital of one who began with 1 and betted on less.
// Bets are constant, a mixture over a grid that is fixed beforehand, each a factor
// 1 + bet * weight * (least - value) a start (Waudby-Smith and Ramdas 2024, Journal of the Royal
// Statistical Society B 86:1, the mixture of their section 4.3 over bets that do not learn). Where
// the hypothesis holds, its expectation is at most 1: of independent outcomes with expectations of
// their own, because a product is at most the power of the mean of its factors; of outcomes drawn
// alike, after each of them, so that by Ville's inequality it ever exceeds 1 / e with chance at most
// e. It does not depend on the order.
double log_evidence_below(std::span<const BoundedOutcome> outcomes, double least);

// The weighted mean with all that is not refused so, half of the error for either side: at each
// time it holds with that confidence, and, of outcomes drawn alike, at all times together.
Interval bounds_by_betting(std::span<const BoundedOutcome> outcomes, double confidence = 0.95);

}  // namespace probe::stats
