// Sets of instances of one scene, a bit each, as rays carry them; from the 32nd on they share the
// last bit.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace probe::render {

using InstanceSet = std::uint32_t;
inline constexpr InstanceSet kAllInstances = ~InstanceSet{0};

constexpr InstanceSet instance_bit(std::size_t instance) {
  return InstanceSet{1} << std::min<std::size_t>(instance, 31);
}

// The instances that rays of each 8 x 8 block of a tile can meet, in sample order; blocks without
// any are not traced.
using BlockSets = std::array<InstanceSet, 4>;
inline constexpr BlockSets kAllBlocks{kAllInstances, kAllInstances, kAllInstances, kAllInstances};

constexpr bool is_empty(const BlockSets& blocks) {
  return (blocks[0] | blocks[1] | blocks[2] | blocks[3]) == 0;
}

}  // namespace probe::render
