// Draws that depend on a seed and a name alone, so that methods do not share their luck and the
// order in which they draw does not matter to one another. Header only.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "runtime/base/hash_number.h"
#include "runtime/base/sha256.h"

namespace probe::search {

// SplitMix64 (Steele, Lea, Flood 2014) of a key that is a hash: millions of draws a search.
class Draws {
 public:
  Draws(std::uint64_t seed, std::string_view name)
      : state_(little_endian_number(sha256(std::to_string(seed) + '/' + std::string(name)))) {}

  std::uint64_t next() {
    std::uint64_t z = state_ += 0x9e3779b97f4a7c15ULL;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
    return z ^ (z >> 31);
  }
  // In [0, 1), never 0 itself where a quantile is drawn: the middles of 2^53 parts.
  double uniform() { return (static_cast<double>(next() >> 11) + 0.5) * 0x1.0p-53; }
  // 0..n-1, n below 2^32: the high half of a product; its bias is below n / 2^32.
  std::uint32_t below(std::uint32_t n) {
    return static_cast<std::uint32_t>(((next() >> 32) * n) >> 32);
  }

 private:
  std::uint64_t state_;
};

}  // namespace probe::search
