// What can be known of a program without running it: intervals of every register, one pass over the
// straight-line code. Measurements are known by their kind: a distance is not negative, and nothing
// leaves the room.
#pragma once

#include <compare>
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

// How large the world of a task is: no body is ever farther from the origin on any axis (m), none
// has a larger half extent (m). Twenty metres are more than an arm throws.
struct Room {
  double farthest = 20, largest = 10;
  auto operator<=>(const Room&) const = default;
};

struct Findings {
  std::vector<ConstantMetric> constants;
  // Conditions joined by `and` that exclude one another, by instruction.
  std::vector<std::size_t> contradictions;
};

// `horizon` in control steps, `control_hz` of them a second.
Findings find_constants(const Program& program, std::uint64_t horizon, double control_hz,
                        const Room& room);

}  // namespace probe::lower
