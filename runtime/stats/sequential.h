// A comparison that may be looked at after every start and stopped at any time without spending its
// error.
#pragma once

#include <cstdint>

namespace probe::stats {

// Counts the starts that one side won. Under the hypothesis of no difference each such start is won
// by either side with chance 1/2, whatever the number of seeds behind it, so the mixture likelihood
// ratio 2^n B(w + 1/2, l + 1/2) / B(1/2, 1/2) is a nonnegative martingale with mean 1 (Robbins
// 1970, Annals of Mathematical Statistics 41:1397) and by Ville's inequality exceeds 1/alpha with
// chance at most alpha, at any time, however often one looks.
class SequentialComparison {
 public:
  // One start's outcome: positive where A did better, negative where B did, 0 for a tie (no news).
  void add(std::int64_t a_minus_b);

  std::int64_t a_wins() const { return a_wins_; }
  std::int64_t b_wins() const { return b_wins_; }

  // The natural logarithm of the likelihood ratio now.
  double log_evidence() const;

  // The anytime-valid p value: 1 / the largest likelihood ratio seen so far, at most 1. Stopping as
  // soon as it is at most alpha errs with chance at most alpha.
  double p_value() const;

 private:
  std::int64_t a_wins_ = 0;
  std::int64_t b_wins_ = 0;
  double largest_log_evidence_ = 0;
};

}  // namespace probe::stats
