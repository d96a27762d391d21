// What can be known of a program without running it: intervals of every register, one pass over the
// straight-line code. Measurements are known by their kind: a distance is not negative, and nothing
// leaves the room.
#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "compiler/lower/program.h"

namespace probe::lower {

struct Interval {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool is_point() const { return low == high; }
};

// A body as it is put down: what the instructions measure of it (m, world), as far as it is known.
struct PlacedBody {
  std::array<Interval, 3> position, origin, half;
  std::array<std::array<Interval, 3>, 3> axes;  // unit vectors
};

struct ConstantMetric {
  std::size_t metric = 0;
  bool value = false;
  std::optional<double> number;  // of a metric that is no condition
};

// How large the world of a task is: no body is ever farther from the origin on any axis (m), none
// has a larger half extent (m). Twenty metres are more than an arm throws.
struct Room {
  double farthest = 20, largest = 10;
  // Limits of the joints of fixtures (m, rad), in the scene's order; infinite where there are none.
  std::vector<std::pair<double, double>> joints = {};
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

// A world in which nothing has moved yet: things lie where they were put down.
struct AtRest {
  std::vector<PlacedBody> placed;  // by body; as made where nothing is known
  std::vector<Interval> joints;    // of fixtures, m or rad
  // Whether two bodies touch; nothing where that is not known.
  std::function<std::optional<bool>(std::uint16_t, std::uint16_t)> touch;
};

// Whether a metric of a program holds there, however long it stays so; nothing when that cannot be
// told.
std::optional<bool> holds_at_rest(const Program& program, std::size_t metric, const AtRest& rest);

// Whether the one metric of a program of measurements holds of bodies as they are put down; nothing
// when that cannot be told.
std::optional<bool> holds(const Program& program, std::span<const PlacedBody> placed);

}  // namespace probe::lower
