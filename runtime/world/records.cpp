#include "runtime/world/records.h"

#include <algorithm>

namespace probe::world {

std::uint32_t PairTable::find_or_add(ColliderPair* pair, std::uint32_t key) {
  const auto at = std::lower_bound(
      pair->near.begin(), pair->near.end(), key,
      [](const ColliderPair::Entry& entry, std::uint32_t k) { return entry.key < k; });
  if (at != pair->near.end() && at->key == key) return at->record;
  std::uint32_t index = 0;
  if (free_.empty()) {
    index = static_cast<std::uint32_t>(pool_.size());
    pool_.emplace_back();
    free_.reserve(pool_.capacity());  // giving back never allocates
  } else {
    index = free_.back();
    free_.pop_back();
    pool_[index] = PairRecord{};
  }
  pair->near.insert(at, {key, index});
  return index;
}

void PairTable::forget_apart(ColliderPair* pair, std::uint64_t substep) {
  std::size_t kept = 0;
  for (const ColliderPair::Entry& entry : pair->near) {
    const PairRecord& record = pool_[entry.record];
    if (record.frozen || record.near >= substep) {
      pair->near[kept++] = entry;
    } else {
      free_.push_back(entry.record);
    }
  }
  pair->near.resize(kept);
}

void PairTable::clear(ColliderPair* pair) {
  for (const ColliderPair::Entry& entry : pair->near) free_.push_back(entry.record);
  pair->near.clear();
}

void PairTable::clear() {
  for (ColliderPair& pair : pairs) pair.near.clear();
  pool_.clear();
  free_.clear();
}

}  // namespace probe::world
