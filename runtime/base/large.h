// How much is read of what others made. The limits keep a verb within a gigabyte and ten seconds
// whatever it is given; a user who trusts a file that is larger says so, and all of them are
// multiplied by one factor. Every such limit is asked here.
#pragma once

#include <concepts>
#include <limits>
#include <string>

namespace probe {

inline constexpr int kLargeFactor = 8;

// `--allow-large`: for the rest of this process, before anything is read.
void allow_large();
bool is_large_allowed();

// A limit as it stands now: `usual`, or so many times as much.
template <std::integral T>
T allowed(T usual) {
  constexpr T kMost = std::numeric_limits<T>::max();
  if (!is_large_allowed()) return usual;
  return usual > kMost / kLargeFactor ? kMost : static_cast<T>(usual * kLargeFactor);
}

// Behind the sentence of a refusal: how it is lifted; empty where it was.
std::string large_hint();

}  // namespace probe
