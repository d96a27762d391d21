// What pairs of colliders remember, kept only where parts are near each other: two objects of 256
// parts could touch in 65,536 pairs of parts and touch in a dozen. Records live in one pool; each
// pair of colliders lists its own by the pair of parts, in ascending order.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "runtime/world/state.h"

namespace probe::world {

// A pair of colliders (b = -1: the plane).
struct ColliderPair {
  // The parts i of A and k of B: key = i x parts of B + k; 0 for the plane, which meets A as a
  // whole.
  struct Entry {
    std::uint32_t key = 0;
    std::uint32_t record = 0;  // index of PairTable's pool
  };
  int a = -1, b = -1;
  std::uint32_t keys = 0;   // of pairs of parts
  double friction = 0;      // coefficient
  Vec3 sum = Vec3::Zero();  // N s, impulse on A since the step began, world
  std::vector<Entry> near;  // ascending by key
};

class PairTable {
 public:
  std::vector<ColliderPair> pairs;
  std::uint64_t step_begin = 0;  // the substep that the sums begin with

  PairRecord& record(std::uint32_t index) { return pool_[index]; }
  const PairRecord& record(std::uint32_t index) const { return pool_[index]; }
  std::size_t records_in_use() const { return pool_.size() - free_.size(); }

  // The record of a key, a new one where there is none. Index of the pool: references die with the
  // next new record.
  std::uint32_t find_or_add(ColliderPair* pair, std::uint32_t key);
  // Forgets the records of a pair that are not frozen and whose boxes met last before `substep`.
  void forget_apart(ColliderPair* pair, std::uint64_t substep);
  // Forgets all records of a pair, or of all.
  void clear(ColliderPair* pair);
  void clear();

 private:
  std::vector<PairRecord> pool_;
  std::vector<std::uint32_t> free_;
};

}  // namespace probe::world
