// Whether cases that a search picked fail as they seemed to: fresh trials of each, exact tests.
//
//   Confirm method(space, points, {.trials = 40});
//   while (!method.done()) method.tell(run(method.ask()));  // fresh starts and seeds
//   const Confirmation found = method.confirmation();
//   for (const ConfirmedCase& one : found.cases) if (one.confirmed) say(one.low);
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "runtime/search/method/outcome.h"
#include "runtime/search/method/space.h"
#include "runtime/stats/intervals.h"

namespace probe::search {

struct ConfirmOptions {
  int trials = 40;      // of each case
  int own_trials = 60;  // of the own point, unless a rate is stated
  double error = 0.05;  // that any case is called confirmed, or its bound too high, wrongly: a half
                        // of it for either
  // Cases must fail more often than this. Not stated: more often than the own point does, by an
  // exact upper bound of that from fresh trials, which has a fifth of the error.
  std::optional<double> rate = std::nullopt;
};

struct ConfirmedCase {
  stats::Count failures = {};  // of fresh trials
  int left_out = 0;
  double low = 0;  // one-sided lower bound of the failure rate; those of all cases hold together
  double p = 1;    // Holm's, against the rate; 1 where every trial was left out
  bool confirmed = false;
};

struct Confirmation {
  double rate = 0;   // what the cases were tested against
  stats::Count own;  // failures at the own point; 0 of 0 where a rate was stated
  int left_out = 0;
  std::vector<ConfirmedCase> cases;  // in the order of the points
};

// One-sided bounds of a failure rate (Clopper and Pearson 1934, Biometrika 26:404), which hold with
// `confidence` at least whatever the rate; 0 and 1 where nothing was tried.
double exact_lower(stats::Count failures, double confidence);
double exact_upper(stats::Count failures, double confidence);

// Every case against one rate by its exact binomial tail, Holm over the cases. Trials that are left
// out are run again, twice as many at most.
class Confirm {
 public:
  Confirm(const Space& space, std::vector<Point> points, const ConfirmOptions& options);

  bool done() const { return ask_.empty(); }
  std::span<const Point> ask() const { return ask_; }
  void tell(std::span<const Outcome> outcomes);
  Confirmation confirmation() const;

 private:
  struct Tried {
    Point point;
    int wanted = 0, asked = 0, left_out = 0;
    stats::Count failures = {};
  };
  void next();

  ConfirmOptions options_;
  std::vector<Tried> tried_;  // the own point first, where it is run
  std::vector<Point> ask_;
  std::vector<std::size_t> of_;  // which of tried_, a trial
};

}  // namespace probe::search
