// The table magnitudes.def: how large and how small the numbers of a plan may be.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace probe::plan {

enum class Magnitude : std::uint8_t {
#define PROBE_MAGNITUDE(name, what, least, most, unit) k##name,
#include "runtime/plan/magnitudes.def"
#undef PROBE_MAGNITUDE
};

struct MagnitudeInfo {
  std::string_view what;
  double least = 0, most = 0;  // of the absolute value, SI
  std::string_view unit;       // empty for what has none

  // 0 fits: whether it is allowed is for the field's own rule.
  bool fits(double value) const {
    return value == 0 || (std::abs(value) >= least && std::abs(value) <= most);
  }
};

inline constexpr MagnitudeInfo kMagnitudes[] = {
#define PROBE_MAGNITUDE(name, what, least, most, unit) {what, least, most, unit},
#include "runtime/plan/magnitudes.def"
#undef PROBE_MAGNITUDE
};

constexpr const MagnitudeInfo& info(Magnitude magnitude) {
  return kMagnitudes[static_cast<std::size_t>(magnitude)];
}

}  // namespace probe::plan
