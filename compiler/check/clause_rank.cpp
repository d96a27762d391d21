// What is done first or last, held to the order that success wants.
#include "compiler/check/clause_lacks.h"

namespace probe::sema {

Lack rank_lack(const ClauseFacts& facts, const Rank& rank) {
  if (rank.of.size() != 1) return std::nullopt;
  const ObjectId thing = *rank.of.begin();
  for (const auto& [first, second] : facts.goal.order) {
    const Things& wrong = rank.is_last ? first : second;
    const Things& right = rank.is_last ? second : first;
    if (!wrong.contains(thing) || right.contains(thing) || right.empty()) continue;
    return "succeeds when " + facts.name(*first.begin()) + " comes before " +
           facts.name(*second.begin());
  }
  return std::nullopt;
}

}  // namespace probe::sema
