// The smallest change that breaks a policy, in the joint space of all axes: the cross-entropy
// method. What it finds is a guess, picked as the best of many: `confirm.h` says whether it holds.
//
//   Worst method(space, {.seed = 7});
//   while (!method.done()) method.tell(run(method.ask()));  // points in, an outcome each out
//   const std::vector<Candidate> candidates = method.candidates();
//   Confirm confirm(space, points_of(candidates), {.trials = 40});  // then the same two lines
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "runtime/search/method/outcome.h"
#include "runtime/search/method/space.h"
#include "runtime/stats/intervals.h"

namespace probe::search {

struct WorstOptions {
  std::uint64_t seed = 0;
  int points = 40;             // a round
  int repeats = 2;             // trials a point, which stand side by side in ask()
  int rounds = 12;             // at most
  double elite = 0.2;          // the share of a round that the next is drawn after
  double smoothing = 0.7;      // weight of the elite against what was before
  double spread_floor = 0.02;  // of standard deviations and of the chance to change an axis
  double broken = 0.5;         // a point fails whose failure rate is at least this
  int keep = 5;                // candidates at the end
  int second_look = 8;         // further trials of each of 3 keep, before the last choice
};

struct Candidate {
  Point point;
  stats::Count failures = {};  // of the search, so too many: the best of many is lucky
  double distance = 0;         // from the own point
};

// Rubinstein and Kroese 2004, The Cross-Entropy Method, algorithm 4.1 with smoothing (5.2). A point
// changes each axis with a chance of its own; a changed continuous axis or count is a truncated
// normal, a choice one of its options; a fifth of each round, and all of the first, is drawn over
// the whole space, few axes at a time. Elite are failing points first, of those the nearest to the
// own point. The end: the nearest failing points of all rounds, none like a nearer one (the same
// axes changed, and nowhere more than a tenth of an axis apart), looked at again, then chosen.
class Worst {
 public:
  Worst(Space space, const WorstOptions& options);
  ~Worst();
  Worst(Worst&&) noexcept;
  Worst& operator=(Worst&&) noexcept;

  bool done() const;
  std::span<const Point> ask() const;
  void tell(std::span<const Outcome> outcomes);
  // Best first; empty where nothing failed. At any time, of what was told so far.
  std::vector<Candidate> candidates() const;
  int trials() const;  // that count
  int left_out() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

std::vector<Point> points_of(std::span<const Candidate> candidates);

}  // namespace probe::search
