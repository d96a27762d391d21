// Whether two axes, or an axis and the outcome, go together over some trials: an exact test over
// all ways to cut them in two. A part of axes.
#pragma once

#include <cstddef>
#include <vector>

#include "runtime/search/method/draws.h"
#include "runtime/search/method/parts.h"

namespace probe::search {

// The pair of cuts at which two axes go together most.
struct BestCuts {
  double square = 0;  // chi-square of the fourfold table
  std::size_t cut_a = 0, cut_b = 0;
  bool is_less = false;  // fewer on both further sides than expected
};

struct IndependenceTest {
  double p = 1;
  BestCuts best;
};

// The largest chi-square over all pairs of cuts with five trials or more on each side, against its
// values where one is permuted among trials that have the same parts of all of `within`: sequential
// Monte Carlo (Besag and Clifford 1991, Biometrika 78:301), ten exceedances or `permutations`.
IndependenceTest independence(const Parts& a, const Parts& b, std::vector<std::size_t> among,
                              const std::vector<const Parts*>& within, int permutations,
                              Draws draws);

}  // namespace probe::search
