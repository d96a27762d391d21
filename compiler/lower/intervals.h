// What can be known of a program without running it: intervals of every register, one pass over the
// straight-line code. Measurements are known by their kind: a distance is not negative, and nothing
// leaves the room.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "compiler/lower/program.h"

namespace probe::lower {

struct ConstantMetric {
  std::size_t metric = 0;
  bool value = false;
  std::optional<double> number;  // of a metric that is no condition
};

struct Findings {
  std::vector<ConstantMetric> constants;
  // Conditions joined by `and` that exclude one another, by instruction.
  std::vector<std::size_t> contradictions;
};

// `horizon` in control steps, `control_hz` of them a second.
Findings find_constants(const Program& program, std::uint64_t horizon, double control_hz);

}  // namespace probe::lower
