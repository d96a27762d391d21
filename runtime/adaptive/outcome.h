// How an episode ended, as far as its rate is asked about.
#pragma once

#include <cstdint>

namespace probe::adaptive {

enum class Outcome : std::uint8_t {
  kAbsent,
  kUnderWay,
  kFailure,
  kSuccess,
  kUnknown,       // invalid: it may have been either
  kNotAttempted,  // it is no part of the rate
};

inline bool has_ended(Outcome outcome) { return outcome > Outcome::kUnderWay; }

}  // namespace probe::adaptive
