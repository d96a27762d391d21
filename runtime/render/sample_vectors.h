// The four samples of a pixel as registers, and the rule of which triangle each of them shows.
#pragma once

#include <cstdint>
#include <cstring>

namespace probe::render::samples {

using Floats = float __attribute__((vector_size(16)));
using Ints = std::int32_t __attribute__((vector_size(16)));

// Puts those that pass into the buffer.
inline void put(const Ints& inside, const Floats& nearness, std::int32_t id, float* there,
                std::uint32_t* ids) {
  Floats old;
  std::memcpy(&old, there, sizeof old);
  Ints was;
  std::memcpy(&was, ids, sizeof was);
  const Ints pass = inside & ((nearness > old) | ((nearness == old) & (id >= was)));
  const Floats now = pass ? nearness : old;
  std::memcpy(there, &now, sizeof now);
  const Ints is = pass ? Ints{} + id : was;
  std::memcpy(ids, &is, sizeof is);
}

// Which of a pixel's samples are drawn into.
inline Ints first_samples(int count) { return Ints{0, 1, 2, 3} < Ints{} + count; }

}  // namespace probe::render::samples
