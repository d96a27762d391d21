// Straight lines between what was measured.
#include "runtime/robot/turning_fingers.h"

#include <algorithm>
#include <limits>

#include "runtime/base/check.h"

namespace probe::robot {
namespace {

double between(double a, double b, double share) { return a + share * (b - a); }

// Where a value stands among those of the list, which grow: the one before, and the share of the
// way to the next.
struct Place {
  std::size_t before = 0;
  double share = 0;
};
Place place_of(const TurningFingers& fingers, double FingersAt::*what, double value) {
  PROBE_CHECK(fingers.size() >= 2, "fingers at two openings at least");
  std::size_t i = 0;
  while (i + 2 < fingers.size() && fingers[i + 1].*what < value) ++i;
  const double low = fingers[i].*what, high = fingers[i + 1].*what;
  return {i, high > low ? std::clamp((value - low) / (high - low), 0.0, 1.0) : 0};
}

}  // namespace

FingersAt fingers_at(const TurningFingers& fingers, double openness) {
  const Place at = place_of(fingers, &FingersAt::openness, openness);
  const FingersAt &a = fingers[at.before], &b = fingers[at.before + 1];
  FingersAt out;
  out.openness = between(a.openness, b.openness, at.share);
  out.gap_half = between(a.gap_half, b.gap_half, at.share);
  out.tip_below = between(a.tip_below, b.tip_below, at.share);
  for (std::size_t i = 0; i < FingersAt::kHeights; ++i) {
    out.inner[i] = between(a.inner[i], b.inner[i], at.share);
    out.outer[i] = between(a.outer[i], b.outer[i], at.share);
  }
  return out;
}

double openness_of_gap(const TurningFingers& fingers, double gap_half) {
  const Place at = place_of(fingers, &FingersAt::gap_half, gap_half);
  return between(fingers[at.before].openness, fingers[at.before + 1].openness, at.share);
}

namespace {

double face(const std::array<double, FingersAt::kHeights>& faces, const FingersAt& at,
            double palm_above, double x) {
  constexpr double kLast = FingersAt::kHeights - 1;
  const double up =
      std::clamp((at.tip_below - x) / (at.tip_below + palm_above) * kLast, 0.0, kLast);
  const auto i = std::min(static_cast<std::size_t>(up), FingersAt::kHeights - 2);
  return between(faces[i], faces[i + 1], up - static_cast<double>(i));
}

}  // namespace

double inner_face(const FingersAt& at, double palm_above, double x) {
  if (x > at.tip_below) return std::numeric_limits<double>::infinity();
  return face(at.inner, at, palm_above, x);
}

double outer_face(const FingersAt& at, double palm_above, double x) {
  return face(at.outer, at, palm_above, x);
}

}  // namespace probe::robot
