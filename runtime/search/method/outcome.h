// What a trial of a search came to. Every method here is asked and told the same way:
//
//   Boundary method({.levels = 41, .seed = 7});           // or Worst, Confirm, Minimal, Axes
//   while (!method.done()) method.tell(run(method.ask()));  // one outcome a trial, in order
//   const BoundaryFinding found = method.finding();
//
// ask() is the batch to run now and stays the same until it is told; its trials may run at once and
// in any order. What is asked next depends on the options and on what was told, nothing else, so a
// search is resumed by a new method that is told the stored outcomes batch by batch: resume().
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace probe::search {

enum class Outcome : std::uint8_t {
  kSucceeded,
  kFailed,
  kLeftOut,  // an unfair point or an episode that does not count: the method goes on elsewhere
};

// Every option in counts of trials, shares in 0..1; a confidence is that of a two-sided interval.
inline constexpr double kConfidence = 0.95;

// Tells a new method what is stored, in the order of asking, as far as it fills batches. Returns
// how many outcomes were told; what is left belongs to the first trials of ask().
template <typename Method>
std::size_t resume(Method& method, std::span<const Outcome> stored) {
  std::size_t told = 0;
  while (!method.done() && stored.size() - told >= method.ask().size()) {
    const std::size_t size = method.ask().size();
    method.tell(stored.subspan(told, size));
    told += size;
  }
  return told;
}

}  // namespace probe::search
