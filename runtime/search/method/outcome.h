// What a trial of a search came to. Every method here is asked and told the same way:
//
//   Boundary method({.levels = 41, .seed = 7});           // or Worst, Confirm, Minimal, Axes
//   while (!method.done()) method.tell(run(method.ask()));  // one outcome a trial, in order
//   const BoundaryFinding found = method.finding();
//
// ask() is the batch to run now and stays the same until it is told; its trials may run at once and
// in any order. What is asked next depends on the options and on what was told, nothing else, so a
// search is resumed by a new method that is told the stored outcomes batch by batch.
#pragma once

#include <cstdint>

namespace probe::search {

enum class Outcome : std::uint8_t {
  kSucceeded,
  kFailed,
  kLeftOut,  // an unfair point or an episode that does not count: the method goes on elsewhere
};

// Every option in counts of trials, shares in 0..1; a confidence is that of a two-sided interval.
inline constexpr double kConfidence = 0.95;

}  // namespace probe::search
