// Least, greatest and truths as selections, which loops over arrays turn into vector instructions.
#pragma once

#include <cstdint>
#include <limits>

namespace probe::render {

inline constexpr float kInfinite = std::numeric_limits<float>::infinity();

template <typename T>
inline T least(T a, T b) {
  return a < b ? a : b;
}
template <typename T>
inline T greatest(T a, T b) {
  return a > b ? a : b;
}
template <typename T>
inline T least(T a, T b, T c) {
  return least(least(a, b), c);
}
template <typename T>
inline T greatest(T a, T b, T c) {
  return greatest(greatest(a, b), c);
}
inline std::int32_t is(bool truth) { return truth ? 1 : 0; }

}  // namespace probe::render
