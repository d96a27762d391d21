// Numbers out of hashes, for draws and shards. Both orders of bytes stand in plans and folders that
// exist, so neither can give way to the other. Header only.
#pragma once

#include <cstddef>
#include <cstdint>

#include "runtime/base/sha256.h"

namespace probe {

inline constexpr std::size_t kNumbersOfHash = 4;

// The `index`-th 64 bits of a hash, below kNumbersOfHash, the first byte the least.
constexpr std::uint64_t little_endian_number(const Sha256& hash, std::size_t index = 0) {
  std::uint64_t number = 0;
  for (std::size_t i = 8; i-- > 0;) number = number << 8 | hash.bytes[8 * index + i];
  return number;
}

// The same, the first byte the greatest.
constexpr std::uint64_t big_endian_number(const Sha256& hash, std::size_t index = 0) {
  std::uint64_t number = 0;
  for (std::size_t i = 0; i < 8; ++i) number = number << 8 | hash.bytes[8 * index + i];
  return number;
}

}  // namespace probe
