// Three floats in a register of four, for loops over hits whose data lie in records: the same
// operations in the same order as on three floats, so the same bits. The fourth lane is whatever
// lay behind the third.
#pragma once

#include <cstring>

namespace probe::render {

using Vec4 = float __attribute__((vector_size(16)));

// Reads four floats; the record must be that long.
inline Vec4 load4(const float* p) {
  Vec4 v;
  std::memcpy(&v, p, sizeof v);
  return v;
}

inline Vec4 splat(float x) { return Vec4{x, x, x, x}; }

// (a.x b.x + a.y b.y) + a.z b.z.
inline float dot3(Vec4 a, Vec4 b) {
  const Vec4 m = a * b;
  return m[0] + m[1] + m[2];
}

// a.y b.z - a.z b.y and so on.
inline Vec4 cross3(Vec4 a, Vec4 b) {
  const Vec4 a_yzx = __builtin_shufflevector(a, a, 1, 2, 0, 3);
  const Vec4 a_zxy = __builtin_shufflevector(a, a, 2, 0, 1, 3);
  const Vec4 b_yzx = __builtin_shufflevector(b, b, 1, 2, 0, 3);
  const Vec4 b_zxy = __builtin_shufflevector(b, b, 2, 0, 1, 3);
  return a_yzx * b_zxy - a_zxy * b_yzx;
}

}  // namespace probe::render
