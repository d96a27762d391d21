// Many tests at once: p values adjusted so that a list of findings keeps its promised error.
#pragma once

#include <span>
#include <vector>

namespace probe::stats {

// Benjamini and Hochberg's step-up (JRSS B 1995, 57:289): rejecting where the adjusted value is at
// most q keeps the expected share of false discoveries at most q. In the order of `p`; NaN (no
// test) stays NaN and does not count.
std::vector<double> benjamini_hochberg(std::span<const double> p);

// Holm's step-down (Scand. J. Statist. 1979, 6:65): rejecting where the adjusted value is at most a
// keeps the chance of any false rejection at most a, whatever the dependence.
std::vector<double> holm(std::span<const double> p);

}  // namespace probe::stats
