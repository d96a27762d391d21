// Numbers of how a point moved, from its positions alone. Knows nothing of traces and tasks.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/base/geometry.h"

namespace probe::rejudge {

enum class MotionKind : std::size_t {
#define PROBE_MOTION(name, unit, better, meaning) k_##name,
#include "runtime/rejudge/motion.def"
};

struct MotionInfo {
  MotionKind kind;
  std::string_view name, unit;
  int better;
  std::string_view meaning;
};
// In the order of motion.def.
std::span<const MotionInfo> all_motions();

// A number, or why there is none.
struct Told {
  std::optional<double> value;
  std::string why_not;
};

// In: positions in m at `hz` samples a second, the first before anything moved. Out: one a line of
// motion.def. Without motion (a path below 1 mm) the smoothness of it has no value, nor has that of
// fewer than 5 positions.
std::vector<Told> motion_of(std::span<const Vec3> positions, double hz);

// Speeds between neighbours, m/s: one less than there are positions.
std::vector<double> speeds_of(std::span<const Vec3> positions, double hz);

// Spectral arc length: minus the length of the curve that the speed's Fourier magnitude, divided by
// that of frequency 0, draws over frequency divided by the highest that counts. That is the last
// one, below 10 Hz and half the rate, with a magnitude of at least 0.05. Zeros make the speeds 16
// times as long or more, a power of two.
// Balasubramanian, Melendez-Calderon, Roby-Brami, Burdet 2015, "On the analysis of movement
// smoothness", J. NeuroEngineering Rehabil. 12:112 (SPARC). Slow samples cut the spectrum: values
// compare at equal rates alone. The speeds are not all 0.
double spectral_arc_length(std::span<const double> speeds, double hz);

// -ln(T^3 / v_max^2 * integral of (d2v/dt2)^2 dt) with T the time of all speeds (LDLJ, there).
// Second differences stand for the second derivative. At least 3 speeds, not all 0; a constant
// speed has no jerk and no value.
std::optional<double> log_dimensionless_jerk(std::span<const double> speeds, double hz);

}  // namespace probe::rejudge
