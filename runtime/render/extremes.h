// Least, greatest, truths and signs without branches, which loops over arrays turn into vector
// instructions.
#pragma once

#include <cstdint>
#include <cstring>
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

// Which of four numbers are negative, the first in the lowest bit.
inline std::uint32_t signs_of(const std::int32_t* four) {
#ifdef __SSE2__
  float __attribute__((vector_size(16))) values;
  std::memcpy(&values, four, sizeof values);
  return static_cast<std::uint32_t>(__builtin_ia32_movmskps(values));
#else
  std::uint32_t out = 0;
  for (std::uint32_t i = 0; i < 4; ++i) out |= (four[i] < 0 ? 1u : 0u) << i;
  return out;
#endif
}

}  // namespace probe::render
