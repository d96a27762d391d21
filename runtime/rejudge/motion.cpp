#include "runtime/rejudge/motion.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <complex>
#include <numbers>

#include "runtime/base/trig.h"

namespace probe::rejudge {
namespace {

constexpr double kHighest = 10;  // Hz
constexpr double kLeastMagnitude = 0.05;
constexpr std::size_t kPadding = 16;  // zeros behind the speeds make the spectrum so much finer
constexpr double kStill = 0.01;       // m/s
constexpr double kLeastPath = 1e-3;   // m
constexpr std::size_t kLeastPositions = 5;

constexpr MotionInfo kMotions[] = {
#define PROBE_MOTION(name, unit, better, meaning) \
  {MotionKind::k_##name, #name, unit, better, meaning},
#include "runtime/rejudge/motion.def"
};

// Cooley and Tukey's transform in place; the size is a power of two.
void transform(std::vector<std::complex<double>>& x) {
  const std::size_t n = x.size();
  for (std::size_t i = 1, j = 0; i < n; ++i) {
    std::size_t bit = n >> 1;
    for (; (j & bit) != 0; bit >>= 1) j ^= bit;
    j ^= bit;
    if (i < j) std::swap(x[i], x[j]);
  }
  std::vector<std::complex<double>> roots(n / 2);
  for (std::size_t k = 0; k < roots.size(); ++k) {
    const double angle = -2 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(n);
    roots[k] = {portable_cos(angle), portable_sin(angle)};
  }
  for (std::size_t length = 2; length <= n; length *= 2) {
    for (std::size_t first = 0; first < n; first += length) {
      for (std::size_t k = 0; k < length / 2; ++k) {
        const std::complex<double> even = x[first + k];
        const std::complex<double> odd = x[first + k + length / 2] * roots[k * (n / length)];
        x[first + k] = even + odd;
        x[first + k + length / 2] = even - odd;
      }
    }
  }
}

}  // namespace

std::span<const MotionInfo> all_motions() { return kMotions; }

std::vector<double> speeds_of(std::span<const Vec3> positions, double hz) {
  std::vector<double> speeds;
  for (std::size_t i = 1; i < positions.size(); ++i)
    speeds.push_back((positions[i] - positions[i - 1]).norm() * hz);
  return speeds;
}

double spectral_arc_length(std::span<const double> speeds, double hz) {
  const std::size_t size = std::bit_ceil(speeds.size()) * kPadding;
  std::vector<std::complex<double>> spectrum(size);
  std::copy(speeds.begin(), speeds.end(), spectrum.begin());
  transform(spectrum);
  const double step = hz / static_cast<double>(size);
  std::vector<double> magnitudes;
  for (std::size_t k = 0; k <= size / 2 && static_cast<double>(k) * step <= kHighest; ++k)
    magnitudes.push_back(std::abs(spectrum[k]) / std::abs(spectrum[0]));
  while (magnitudes.size() > 2 && magnitudes.back() < kLeastMagnitude) magnitudes.pop_back();
  const double across = 1 / static_cast<double>(magnitudes.size() - 1);
  double length = 0;
  for (std::size_t k = 1; k < magnitudes.size(); ++k)
    length += std::hypot(across, magnitudes[k] - magnitudes[k - 1]);
  return -length;
}

std::optional<double> log_dimensionless_jerk(std::span<const double> speeds, double hz) {
  const double fastest = *std::ranges::max_element(speeds);
  double sum = 0;
  for (std::size_t i = 2; i < speeds.size(); ++i) {
    const double jerk = (speeds[i] - 2 * speeds[i - 1] + speeds[i - 2]) * hz * hz;
    sum += jerk * jerk / hz;
  }
  if (!(sum > 0)) return std::nullopt;
  const double time = static_cast<double>(speeds.size()) / hz;
  return -std::log(time * time * time / (fastest * fastest) * sum);
}

std::vector<Told> motion_of(std::span<const Vec3> positions, double hz) {
  const std::vector<double> speeds = speeds_of(positions, hz);
  double path = 0, still = 0;
  for (const double speed : speeds) {
    path += speed / hz;
    if (speed < kStill) still += 1 / hz;
  }
  const char* why_rough = path < kLeastPath                    ? "the tool did not move"
                          : positions.size() < kLeastPositions ? "fewer than 4 steps"
                                                               : nullptr;
  std::vector<Told> out;
  for (const MotionInfo& motion : kMotions) {
    Told& told = out.emplace_back();
    switch (motion.kind) {
      case MotionKind::k_path:
        told.value = path;
        break;
      case MotionKind::k_still:
        told.value = still;
        break;
      case MotionKind::k_sparc:
      case MotionKind::k_log_jerk:
        if (why_rough != nullptr) {
          told.why_not = why_rough;
        } else if (motion.kind == MotionKind::k_sparc) {
          told.value = spectral_arc_length(speeds, hz);
        } else if (!(told.value = log_dimensionless_jerk(speeds, hz))) {
          told.why_not = "its speed never changed";
        }
        break;
    }
  }
  return out;
}

}  // namespace probe::rejudge
