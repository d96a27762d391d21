// What can be known of a program without running it: intervals of every register, one pass over the
// straight-line code. Measurements are only known by their kind: a distance is not negative.
#pragma once

#include <cstdint>
#include <vector>

#include "compiler/lower/program.h"

namespace probe::lower {

struct ConstantMetric {
  std::size_t metric = 0;
  bool value = false;
};

struct Findings {
  std::vector<ConstantMetric> constants;
  // Conditions joined by `and` that exclude one another, by instruction.
  std::vector<std::size_t> contradictions;
};

Findings find_constants(const Program& program, std::uint64_t horizon);

}  // namespace probe::lower
