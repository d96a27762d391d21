// How much of one change a policy stands: the tolerance on one side of one axis at which success
// has fallen to half of what it is at the task's own value, by a Bayesian adaptive method.
//
//   Boundary method({.levels = 41, .seed = 7});             // level 0 is the own value
//   while (!method.done()) method.tell(run(method.ask()));  // levels in, an outcome each out
//   const BoundaryFinding found = method.finding();
//   if (found.status == BoundaryStatus::kFound) say(found.threshold, found.low, found.high);
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "runtime/search/method/outcome.h"
#include "runtime/stats/intervals.h"

namespace probe::search {

struct BoundaryOptions {
  int levels = 0;  // 2 at least: 0 the own value, levels-1 the end of the space
  std::uint64_t seed = 0;
  // The half-width of the 95 % interval to stop at, as a share of the axis (levels-1). No finer
  // than half a level: a change between two levels lies between them.
  double error = 0.05;
  int budget = 400;       // trials that count, at most
  int batch = 8;          // trials a batch, 1..8
  int own_trials = 16;    // at level 0 before anything else
  int end_trials = 4;     // at the end, with the first
  int check_trials = 24;  // over the whole axis after a finding, to see whether it is monotone;
                          // once more of them where that is doubtful
  // Success at the own value that is less than this (95 % one-sided) has nothing to fall from.
  double own_at_least = 0.2;
};

enum class BoundaryStatus : std::uint8_t {
  kRunning,
  kFound,            // the interval is as narrow as was asked
  kNoFall,           // success stays above half to the last fair level, with 95 % or more
  kFailsAtOwnValue,  // never, or too seldom, succeeds where nothing is changed
  kNotMonotone,      // success rises again further out: no single tolerance describes it
  kUndecided,        // the budget is spent
  kLeftOut,          // the own value itself was never fair, or nothing beyond it
};

struct BoundaryFinding {
  BoundaryStatus status = BoundaryStatus::kRunning;
  // In levels, not whole: the median of the posterior and an interval that holds the truth in 95 %
  // of searches (98.5 % of the posterior: a search stops when that happens to be narrow). The ends
  // are last_level at most. Of kFound, kUndecided and kNotMonotone (what the monotone model would
  // say, not to be believed).
  double threshold = 0, low = 0, high = 0;
  double no_fall = 0;        // posterior probability that half is not reached up to last_level
  stats::Count own;          // successes at level 0
  stats::Interval own_rate;  // Wilson, 95 %
  int trials = 0;            // that count
  int left_out = 0;
  int last_level = 0;  // the last level that was fair
  // Of kUndecided: an estimate of the budget that would do, by widths that shrink as one over the
  // square root of the trials.
  std::optional<int> budget_needed;
  // Of the test that success nowhere rises with the level (bootstrap of the likelihood ratio
  // against the isotonic fit); 1 before the check.
  double monotone_p = 1;
};

// The psi method (Kontsevich and Tyler 1999, Vision Research 39:2729) with the nuisance parameters
// marginalised (Prins 2013, Journal of Vision 13(7):3): a grid over tolerance t, slope s, own rate
// r and the floor f that success falls to, as a share of r, with
//   success(x) = r (f + (1 - f) G(x)),  G(0) = 1,  success(t) = r / 2,
// G a logistic curve scaled to its own value at 0; s goes from a step to falls over a third of the
// axis; f >= 1/2 and t beyond the end are "no fall". A batch is chosen greedily for the most
// information about t of all its outcomes together, taken as independent given t.
class Boundary {
 public:
  explicit Boundary(const BoundaryOptions& options);
  ~Boundary();
  Boundary(Boundary&&) noexcept;
  Boundary& operator=(Boundary&&) noexcept;

  bool done() const;
  std::span<const int> ask() const;  // levels, empty when done
  void tell(std::span<const Outcome> outcomes);
  BoundaryFinding finding() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace probe::search
