// The exact distribution of a sum of independent whole numbers, each one of a few equally likely
// values: what permutation tests of starts add up. Knows nothing of tests.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <vector>

namespace probe::stats {

class ExactSum {
 public:
  // One more number that is each of `values` with the same chance; equal entries count as often as
  // they stand there. A single value is a constant.
  void add(std::span<const std::int64_t> values);

  // The chance of a sum at least as far from 0 as `observed`. Few numbers are counted out one by
  // one, many are summed by at_least_by_inversion; either is right to nine digits and more, however
  // small the chance (down to 1e-300, what is smaller is 0).
  double tail(std::int64_t observed) const;

  // The two ways, for tail and its tests: the chance of a sum of at least `least`. Counting goes down
  // from the highest sum, so that a tail of few sums is little work whatever their number.
  double at_least_by_counting(std::int64_t least) const;
  // P(S >= s) = e^(K(t) - t s) (1/N) sum_j phi_t(w_j) e^(-i w_j s) / (1 - e^(-t - i w_j)), w_j = 2
  // pi j / N: Fourier's sum of the distribution tilted by e^(t S), which has its mean at s, so that
  // the small chance stands in the factor before it and not in the cancelling of its terms. The sum
  // repeats with period N; N is so long that what comes from its repetitions is below rounding.
  double at_least_by_inversion(std::int64_t least) const;

 private:
  using Values = std::vector<std::int64_t>;  // ascending

  ExactSum mirrored() const;
  std::int64_t highest() const;
  double at_least(std::int64_t least) const;
  double counting_work(std::int64_t least) const;  // additions

  std::map<Values, std::int64_t> times_;  // how often each set of values was added
};

}  // namespace probe::stats
